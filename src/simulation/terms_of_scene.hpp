// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "applied_field.hpp"
#include "evaluate_in_pass.hpp"
#include "field_in_pass.hpp"
#include "io/scene.hpp"
#include "ranks.hpp"
#include "sites_of_cell.hpp"
#include "space.hpp"
#include "terms_along_row.hpp"

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/detail/sweep_plan.hpp>
#include <cayspin/detail/table.hpp>
#include <cayspin/field/site_dependent_exchange.hpp>
#include <cayspin/scalars.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

// The terms of FieldInPass as a scene has them. For field_in_pass.cpp.
namespace cayspin::simulation {

// The largest magnitude in all parts: of doubles >= 0 their words are in the same order.
inline double largest_of_parts(Lattice const& lattice, std::vector<double> const& values) {
  double largest = 0;
  for (double const value : values) largest = std::max(largest, std::abs(value));
  if (lattice.part == nullptr) return largest;
  std::array words{std::bit_cast<std::int64_t>(largest)};
  lattice.part->maximum(words);
  return std::bit_cast<double>(words[0]);
}

// The site of the cell that each of a part's own planes holds.
inline std::size_t site_of_cell(Lattice const& lattice, std::size_t number) {
  auto const in_plane = static_cast<std::size_t>(lattice.own(0) * lattice.own(1));
  return number / in_plane % static_cast<std::size_t>(lattice.cell_sites);
}

template <class Real, class Memory>
ScalarField<Real, Memory> field_of(char const* name, Lattice const& lattice,
                                   std::vector<double> const& numbers) {
  ScalarField<Real, Memory> made(std::string("FieldInPass::") + name, lattice);
  copy_from_host(numbers, made);
  // Terms look at the numbers of neighbours, too.
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

  /// The applied field is the same for all spins, and so H without it is linear in the spins.
  bool adds_applied(FieldFor purpose) const {
    return purpose == FieldFor::generator && std::ranges::all_of(cell_, [&](auto const& site) {
             return site.gyromagnetic == cell_[0].gyromagnetic;
           });
  }

  /// Has each site of a cell the same axes, and a moment and a gyromagnetic ratio of 1?
  bool sites_are_alike() const {
    return std::ranges::all_of(cell_, [&](auto const& site) {
      return site.gyromagnetic == 1 && site.per_moment == 1 && site.quadratic == cell_[0].quadratic;
    });
  }

  /// The terms that are compiled into stages, from `usual`; none where they load the whole H.
  std::optional<SceneFieldNow<Real>> in_stages(SceneFieldNow<Real> const& usual) const;

 private:
  friend FieldInPass;

  void add_numbers_of_sites(io::Scene const& scene, io::SiteBox const& box,
                            std::vector<double> moves);
  void add_vacancies(io::Scene const& scene);

  template <class Element>
  using Table = Kokkos::View<Element*, Memory>;

  struct Torques {
    std::optional<AppliedField> velocity, strengths;  // strengths: damping-like, field-like
    double nonadiabaticity = 0;
    Vec3<double> polarization{0, 0, 1};
  };

  Lattice lattice_;
  SceneLatticeTerms none_;
  PairCouplings<Memory> pairs_;
  Torques torques_;
  Table<CellSite> sites_;
  Table<CubicAnisotropy> cubics_;
  bool has_lattice_terms_ = false, has_pairs_, has_vacancies_, is_affine_;
  std::optional<ScalarField<Real, Memory>> moves_, dampings_, dmi_of_sites_;
  std::optional<ScalarField<Real, Memory>> rates_;  // moves_ over Gilbert's 1 + damping^2
  std::optional<SiteDependentExchange<Real, Memory>> exchange_of_sites_;
  Vec3<double> dmi_vectors_[3] = {};
  std::vector<ScalarField<Real, Memory>> constants_of_axes_;
  Table<AnisotropyOfSites<Real>> anisotropies_;
  bool precession_;
  std::vector<CellSite> cell_;
  SceneLatticeTerms seen_;  // by the moments of a cell with one site
  std::optional<ScalarField<Real, Memory>> missing_;
  double largest_moment_ = 0;
  Spins field_;
  ScalarField<Real, Memory> energies_, moments_;
  // The terms of the stages that are being run: those of a sweep are so together.
  mutable std::array<std::variant<std::monostate, AddedTerms<Real>, WholeTerms<Real>>,
                     cayspin::detail::SweepPlan::most_stages>
      along_rows_;
  mutable std::size_t last_along_rows_ = 0;
};

template <class Spins>
FieldInPass<Spins>::Terms::Terms(io::Scene const& scene, Lattice const& lattice)
    : lattice_(lattice),
      none_(lattice_terms_of({}, lattice)),
      pairs_(lattice, io::couplings(scene)),
      has_pairs_(std::ranges::max(pairs_.field_bounds()) > 0),
      has_vacancies_(io::has_vacancies(scene)),
      is_affine_(io::has_linear_field(scene) && !pairs_.has_biquadratic()),
      precession_(scene.system.precession),
      seen_(none_),
      field_("FieldInPass::field", lattice),
      energies_("FieldInPass::energies", lattice) {
  auto const& torque = scene.field.torque;
  if (auto const& of = torque.zhang_li) {
    torques_.velocity.emplace(of->velocity, "torque.zhang_li.velocity");
    torques_.nonadiabaticity = of->nonadiabaticity;
  }
  if (auto const& of = torque.slonczewski) {
    torques_.strengths.emplace(
        std::array<io::AppliedComponent, 3>{of->damping_like, of->field_like, 0.0},
        "torque.slonczewski");
    torques_.polarization = vector(of->polarization);
  }
  auto const [sites, cubics] = sites_of_cell(scene);
  for (auto const& site : sites) largest_moment_ = std::max(largest_moment_, site.moment);
  cell_ = sites;
  auto seen = io::without_numbers_of_sites(scene.field);
  io::for_each_lattice_term(seen, [&](auto& term) {
    if (term) term->strength() *= sites[0].gyromagnetic * sites[0].per_moment;
  });
  seen_ = lattice_terms_of(seen, lattice);
  sites_ = cayspin::detail::table_of<Memory>("cayspin::FieldInPass::sites", sites);
  cubics_ = cayspin::detail::table_of<Memory>("cayspin::FieldInPass::cubics", cubics);

  auto const box = own_sites(lattice);
  auto const occupied = io::occupied(scene, box), frozen = io::frozen(scene, box);
  std::vector<double> moves(static_cast<std::size_t>(lattice.sites()), 1), moments = moves;
  for (std::size_t site = 0; site < moves.size(); ++site) {
    moves[site] = !frozen.empty() && frozen[site] ? 0 : 1;
    moments[site] =
        !occupied.empty() && !occupied[site] ? 0 : sites[site_of_cell(lattice, site)].moment;
  }
  if (!frozen.empty()) moves_ = field_of<Real, Memory>("moves", lattice, moves);
  moments_ = field_of<Real, Memory>("moments", lattice, moments);
  if (has_vacancies_) add_vacancies(scene);

  add_numbers_of_sites(scene, box, std::move(moves));

  // The round-off of a site's energy is proportional to this.
  auto const uniform = io::without_numbers_of_sites(scene.field);
  io::for_each_lattice_term(uniform, [&](auto const& term) {
    if (!term) return;
    none_.magnitude += term->energy_magnitude(lattice);
    has_lattice_terms_ = true;
  });
  none_.magnitude += 0.5 * std::ranges::max(pairs_.field_bounds());
  for (auto const& term : scene.field.anisotropies)
    none_.magnitude += 0.5 * std::abs(term.constant);
  for (auto const& term : scene.field.cubic_anisotropies)
    none_.magnitude += std::abs(term.constant);
}

// The exchange of stages takes a vacancy, the zero vector, for a neighbour m': it has A (m' - m).
template <class Spins>
void FieldInPass<Spins>::Terms::add_vacancies(io::Scene const& scene) {
  auto const field = io::without_numbers_of_sites(scene.field);
  if (!field.exchange) return;
  missing_.emplace("FieldInPass::missing", lattice_);
  FindMissing<Real> find{moments_.array(), missing_->output(false), {0, 0, 0}};
  double const seen = cell_[0].gyromagnetic * cell_[0].per_moment * field.exchange->constant;
  for (std::size_t axis = 0; axis < 3; ++axis)
    if (lattice_.has_neighbors(static_cast<int>(axis)))
      find.bonds[axis] = seen / (lattice_.spacing[axis] * lattice_.spacing[axis]);
  typename Memory::execution_space const exec;
  cayspin::detail::for_each_site<Real>(exec, "cayspin::FieldInPass::find_missing",
                                       missing_->layout(), find, missing_->layout().own);
  cayspin::detail::update_ghosts(exec, lattice_, *missing_);
  exec.fence("cayspin::FieldInPass: missing neighbours found");
}

template <class Spins>
void FieldInPass<Spins>::Terms::add_numbers_of_sites(io::Scene const& scene, io::SiteBox const& box,
                                                     std::vector<double> moves) {
  auto const& field = scene.field;
  auto const read = [&](char const* name, io::SiteNumbers const& numbers, std::string_view key,
                        double bond_energies) {
    auto const values = io::numbers_of_sites(scene, numbers, key, box);
    none_.magnitude += bond_energies * largest_of_parts(lattice_, values);
    return field_of<Real, Memory>(name, lattice_, values);
  };
  auto const& spacing = lattice_.spacing;
  if (field.exchange_factors.there()) {
    double const bonds = field.exchange->energy_magnitude(lattice_);
    auto const constants = read("exchange", field.exchange_factors, "field.exchange", bonds);
    try {
      exchange_of_sites_.emplace(constants);
    } catch (std::invalid_argument const& error) {
      std::string_view const message = error.what();
      throw io::scene_error(scene, field.exchange_factors.key_or("field.exchange"),
                            message.substr(message.find(": ") + 2));
    }
  }
  if (field.dmi_factors.there()) {
    dmi_of_sites_ = read("dmi", field.dmi_factors, "field.dmi", 6);
    for (int axis = 0; axis < 3; ++axis) {
      if (!lattice_.has_neighbors(axis)) continue;
      Vec3<double> const e{axis == 0 ? 1.0 : 0.0, axis == 1 ? 1.0 : 0.0, axis == 2 ? 1.0 : 0.0};
      dmi_vectors_[axis] = (1 / spacing[static_cast<std::size_t>(axis)]) *
                           (field.bulk_dmi ? -1.0 * e : cross(vector(field.dmi->normal), e));
    }
  }
  if (scene.system.dampings.there()) {
    auto const dampings = io::numbers_of_sites(scene, scene.system.dampings, "system.damping", box);
    dampings_ = field_of<Real, Memory>("dampings", lattice_, dampings);
    if (scene.system.gilbert_of_sites) {
      for (std::size_t site = 0; site < moves.size(); ++site)
        moves[site] /= 1 + dampings[site] * dampings[site];
      rates_ = field_of<Real, Memory>("rates", lattice_, moves);
    }
  }
  std::vector<AnisotropyOfSites<Real>> axes;
  for (auto const& term : field.anisotropies) {
    if (!term.factors.there()) continue;
    auto values = io::numbers_of_sites(scene, term.factors, "field.anisotropy", box);
    for (std::size_t site = 0; site < values.size(); ++site)
      if (term.site >= 0 && site_of_cell(lattice_, site) != static_cast<std::size_t>(term.site))
        values[site] = 0;
    none_.magnitude += 0.5 * largest_of_parts(lattice_, values);
    constants_of_axes_.push_back(field_of<Real, Memory>("anisotropy", lattice_, values));
    axes.push_back({constants_of_axes_.back().array(), vector(term.axis)});
  }
  anisotropies_ = cayspin::detail::table_of<Memory>("cayspin::FieldInPass::anisotropies", axes);
}

}  // namespace cayspin::simulation
