// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "applied_field.hpp"
#include "evaluate_in_pass.hpp"
#include "field_in_pass.hpp"
#include "io/scene.hpp"
#include "largest_field.hpp"
#include "ranks.hpp"
#include "sites_of_cell.hpp"
#include "space.hpp"
#include "terms_along_row.hpp"

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/sweep_plan.hpp>
#include <cayspin/detail/table.hpp>
#include <cayspin/field/site_dependent_exchange.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

// The terms of FieldInPass for a scene. Further headers define the functions that add them;
// compile_field_in_pass.hpp includes all these headers.
namespace cayspin::simulation {

// Returns the largest |value| over all parts of the lattice. Parts compare the bits of doubles as
// integers, which have the same order for doubles >= 0.
inline double largest_of_parts(Lattice const& lattice, std::vector<double> const& values) {
  double largest = 0;
  for (double const value : values) largest = std::max(largest, std::abs(value));
  if (lattice.part == nullptr) return largest;
  std::array words{std::bit_cast<std::int64_t>(largest)};
  lattice.part->maximum(words);
  return std::bit_cast<double>(words[0]);
}

// Returns the index in its cell of site `number` of a part. Sites with equal z have equal indices.
inline std::size_t site_of_cell(Lattice const& lattice, std::size_t number) {
  auto const in_plane = static_cast<std::size_t>(lattice.own(0) * lattice.own(1));
  return number / in_plane % static_cast<std::size_t>(lattice.cell_sites);
}

template <class Real, class Memory>
ScalarField<Real, Memory> scalar_field_of(char const* name, Lattice const& lattice,
                                          std::vector<double> const& numbers) {
  ScalarField<Real, Memory> made(std::string("FieldInPass::") + name, lattice);
  copy_from_host(numbers, made);
  // Terms also read the values at neighbours.
  cayspin::detail::update_ghosts(typename Memory::execution_space(), lattice, made);
  return made;
}

template <class Spins>
class FieldInPass<Spins>::Terms {
 public:
  Terms(io::Scene const& scene, Lattice const& lattice);

  template <class Exec>
  PassTerms<Real> at(Exec const& exec, SceneFieldNow<Real> const& usual, Spins const& spins,
                     double t, FieldFor purpose) const;

  /// Returns true if the kernels of the methods add the applied field, so that H in memory is
  /// linear in the spins. For that, all spins must have the same gyromagnetic ratio.
  bool adds_applied(FieldFor purpose) const {
    return purpose == FieldFor::generator && std::ranges::all_of(cell_, [&](auto const& site) {
             return site.gyromagnetic == cell_[0].gyromagnetic;
           });
  }

  /// Returns true if bonds may reach beyond the neighbours of a site.
  bool reaches_far() const { return has_pairs_ || distant_bonds_.size() > 0; }

  /// Returns true if all sites of a cell have equal uniaxial anisotropies, and a moment and a
  /// gyromagnetic ratio of 1.
  bool sites_are_alike() const {
    return !per_moments_ && std::ranges::all_of(cell_, [&](auto const& site) {
      return site.gyromagnetic == 1 && site.per_moment == 1 && site.quadratic == cell_[0].quadratic;
    });
  }

  /// Returns the terms that are evaluated inside the stages; empty if the stages load the whole H
  /// instead.
  std::optional<SceneFieldNow<Real>> in_stages(SceneFieldNow<Real> const& usual, double t) const;

 private:
  friend FieldInPass;

  // In moments_and_rates_of_scene.hpp.
  void add_moments_of_sites(std::vector<double> const& moments);
  void add_vacancies(io::Scene const& scene);
  void add_rates(io::Scene const& scene, io::SiteBox const& box, std::vector<double> moves);

  // In exchange_and_dmi_of_scene.hpp.
  void add_exchange_of_sites(io::Scene const& scene, io::SiteBox const& box);
  void add_dmi_of_sites(io::Scene const& scene, io::SiteBox const& box);

  // In bonds_between_regions.hpp.
  void add_bonds_between(io::Scene const& scene, io::SiteBox const& box);
  void add_distant_bonds(io::Scene const& scene, io::SiteBox const& box);
  void add_exchange_at_faces(io::Scene const& scene, io::SiteBox const& box);

  // In anisotropies_of_scene.hpp.
  void add_axes(io::Scene const& scene, io::SiteBox const& box, std::vector<double> const& moments);
  void add_crystal_axes(io::Scene const& scene, io::SiteBox const& box);
  SiteArray<Real, 1> keep_constants(std::vector<double> const& constants, double of_energy);
  SiteArray<Real, 3> keep_axes(std::vector<double> const& axes);
  std::vector<double> constants_of_site(io::Scene const& scene, io::SiteBox const& box,
                                        double constant, io::SiteNumbers const& numbers,
                                        int site) const;

  // In sources_of_scene.hpp.
  void add_sources(io::Scene const& scene, io::SiteBox const& box);
  template <class Exec>
  SourcesNow<Real> sources_at(Exec const& exec, double t) const;

  // In torques_of_scene.hpp.
  void add_torques(io::Scene const& scene, io::SiteBox const& box);
  SlonczewskiOfSites<Real> slonczewski_of_sites(Vec3<double> const& strengths) const;

  struct Factors {
    double exchange = 1, anisotropy = 1, dmi = 1;
  };
  Factors factors_at(double t) const;
  SceneLatticeTerms lattice_terms_at(Factors const& factors, double scale) const;

  template <class Element>
  using Table = Kokkos::View<Element*, Memory>;

  struct Torques {
    std::optional<AppliedField> velocity, strengths;  // strengths: damping-like, field-like
    double nonadiabaticity = 0;
    bool velocity_per_moment = false;
    Vec3<double> polarization{0, 0, 1};
    double lambda = 1;
    bool needs_site_term = false;  // site-dependent, or dependent on the angle
    std::optional<ScalarField<Real, Memory>> damping_like, field_like;  // site-dependent; or empty
    std::optional<SiteField<Real, 3, Memory>> polarizations;            // site-dependent; or empty
  };

  struct Source {
    SiteField<Real, 3, Memory> profile;
    AppliedField time;  // the factor is its x component
    double largest;     // largest |profile|
  };

  Lattice lattice_;
  SceneLatticeTerms none_;
  PairCouplings<Memory> pairs_;
  Torques torques_;
  std::vector<Source> sources_;
  // Profiles and factors of the sources beyond SourcesNow::most. Each time has its own row of
  // factors, because the stages of a sweep are in progress at the same time.
  Table<SiteArray<Real, 3>> other_profiles_;
  Kokkos::View<double**, Kokkos::LayoutRight, Memory> other_factors_;
  mutable std::size_t last_factors_ = 0;
  Table<CellSite> sites_;
  Table<CubicAnisotropy> cubics_;
  bool has_lattice_terms_ = false, has_pairs_, has_vacancies_, is_affine_;
  std::optional<ScalarField<Real, Memory>> moves_, dampings_;
  // Site-dependent factors of A: moves_ * (gyromagnetic ratio), divided by 1 + damping^2 for
  // Gilbert dampings.
  std::optional<ScalarField<Real, Memory>> rates_;
  std::optional<ScalarField<Real, Memory>> per_gyromagnetic_;  // for torques; or empty
  std::optional<SiteDependentExchange<Real, Memory>> exchange_of_sites_;
  struct Dmi {
    ScalarField<Real, Memory> constants;
    std::array<Vec3<double>, 3> vectors;  // of the bonds along each axis
  };
  std::vector<Dmi> dmis_of_sites_;
  std::optional<AppliedField> in_time_;  // factors of exchange, anisotropy, DMI
  io::Field uniform_;                    // lattice terms only
  struct Interlayer {
    std::optional<ScalarField<Real, Memory>> bilinear, biquadratic;  // of bonds to next sites
  };
  Interlayer interlayers_[3];
  std::vector<ScalarField<Real, Memory>> numbers_of_distant_;
  Table<DistantBonds<Real>> distant_bonds_;
  double longest_of_distant_ = 0;  // largest spacing along the axes of distant bonds
  std::optional<ScalarField<Real, Memory>> exchange_at_faces_;
  std::int32_t sweeps_of_faces_ = 0;
  std::vector<ScalarField<Real, Memory>> constants_of_axes_;
  std::vector<SiteField<Real, 3, Memory>> axes_of_sites_;
  Table<AnisotropyOfSites<Real>> anisotropies_;
  Table<CrystalAnisotropyOfSites<Real>> crystals_;
  std::int32_t anisotropies_in_time_ = 0;
  bool precession_;
  std::vector<CellSite> cell_;
  SceneLatticeTerms seen_;  // lattice terms * gyromagnetic ratio / moment
  std::optional<ScalarField<Real, Memory>> missing_;
  double largest_moment_ = 0;
  Spins field_;
  ScalarField<Real, Memory> energies_, moments_;
  std::optional<ScalarField<Real, Memory>> per_moments_;  // if each site has its own moment
  // Terms of the stages in progress. The stages of a sweep are in progress at the same time.
  mutable std::array<std::variant<std::monostate, AddedTerms<Real>, WholeTerms<Real>>,
                     cayspin::detail::SweepPlan::most_stages>
      along_rows_;
  mutable std::size_t last_along_rows_ = 0;
};

template <class Spins>
FieldInPass<Spins>::Terms::Terms(io::Scene const& scene, Lattice const& lattice)
    : lattice_(lattice),
      none_(lattice_terms_of(io::Field(), lattice)),
      pairs_(lattice, io::couplings(scene)),
      has_pairs_(std::ranges::max(pairs_.field_bounds()) > 0),
      has_vacancies_(io::has_vacancies(scene)),
      is_affine_(io::has_linear_field(scene) && !pairs_.has_biquadratic()),
      precession_(scene.system.precession),
      seen_(none_),
      field_("FieldInPass::field", lattice),
      energies_("FieldInPass::energies", lattice) {
  auto const [sites, cubics] = sites_of_cell(scene);
  for (auto const& site : sites) largest_moment_ = std::max(largest_moment_, site.moment);
  cell_ = sites;
  auto seen = io::without_numbers_of_sites(scene.field);
  io::for_each_lattice_term(seen, [&](auto& term) {
    if (term) term->strength() *= sites[0].gyromagnetic * sites[0].per_moment;
  });
  seen_ = lattice_terms_of(seen, lattice);
  if (scene.field.in_time.there()) {
    in_time_.emplace(scene.field.in_time.components(), "field.in_time", scene.units);
    auto const uniform = io::without_numbers_of_sites(scene.field);
    uniform_.exchange = uniform.exchange;
    uniform_.dmi = uniform.dmi;
    uniform_.bulk_dmi = uniform.bulk_dmi;
  }
  sites_ = cayspin::detail::table_of<Memory>("cayspin::FieldInPass::sites", sites);
  cubics_ = cayspin::detail::table_of<Memory>("cayspin::FieldInPass::cubics", cubics);

  auto const box = own_sites(lattice);
  auto const frozen = io::frozen(scene, box);
  std::vector<double> moves(static_cast<std::size_t>(box.extent[0] * box.extent[1] * box.extent[2]),
                            1);
  auto moments = io::all_moments(scene, box);
  if (moments.empty()) moments = moves;
  for (std::size_t site = 0; site < frozen.size(); ++site) moves[site] = frozen[site] ? 0 : 1;
  if (!frozen.empty()) moves_ = scalar_field_of<Real, Memory>("moves", lattice, moves);
  moments_ = scalar_field_of<Real, Memory>("moments", lattice, moments);
  if (io::has_moments_of_sites(scene)) add_moments_of_sites(moments);
  if (has_vacancies_ && !per_moments_) add_vacancies(scene);

  add_torques(scene, box);
  add_exchange_of_sites(scene, box);
  add_bonds_between(scene, box);
  add_distant_bonds(scene, box);
  add_exchange_at_faces(scene, box);
  add_dmi_of_sites(scene, box);
  add_rates(scene, box, std::move(moves));
  add_axes(scene, box, moments);
  add_crystal_axes(scene, box);
  add_sources(scene, box);

  // Completes none_.magnitude, to which the round-off of a site's energy is proportional.
  auto const uniform = io::without_numbers_of_sites(scene.field);
  io::for_each_lattice_term(uniform, [&](auto const& term) {
    if (!term) return;
    none_.magnitude += term->energy_magnitude(lattice);
    has_lattice_terms_ = true;
  });
  none_.magnitude += 0.5 * std::ranges::max(pairs_.field_bounds());
  none_.magnitude += 0.5 * largest_moment_ * bound_of_dipoles(scene, lattice);
  // If each site has its own moment, the demagnetising field is proportional to the moments, and
  // its energy to their squares.
  double const square = per_moments_ ? largest_moment_ * largest_moment_ : 1;
  auto const add_demagnetization = [&](double strength) {
    none_.magnitude += 0.5 * square * std::abs(scene.field.mu0 * strength);
  };
  if (auto const& demag = scene.field.demag; demag && !demag->dipoles)
    add_demagnetization(demag->strength);
  if (auto const& slab = scene.field.slab_demag; slab && !slab_of_moments(scene))
    add_demagnetization(slab->strength);
  for (auto const& term : scene.field.anisotropies)
    none_.magnitude += 0.5 * std::abs(term.constant);
  for (auto const& term : scene.field.crystal_anisotropies)
    if (term.is_plain()) none_.magnitude += std::abs(term.constant);
}

}  // namespace cayspin::simulation
