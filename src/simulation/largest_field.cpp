// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "largest_field.hpp"

#include "applied_field.hpp"
#include "failure.hpp"
#include "io/site_box.hpp"
#include "text.hpp"

#include <cayspin/demagnetization/dipolar_bound.hpp>
#include <cayspin/field/bonds_of_sites.hpp>
#include <cayspin/stability.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <optional>
#include <ranges>
#include <string_view>
#include <type_traits>
#include <vector>

namespace cayspin::simulation {
namespace {

// Returns the largest length of a vector at 1001 equally spaced times of the run, or that of its
// time features if it is larger by more than 0.1 %. Features include pulses between these times.
double largest(AppliedField const& vector, std::string_view key, io::Scene const& scene,
               Times const& times, TimeFeatures const& features) {
  if (!vector.present()) return 0;
  int const samples = vector.depends_on_time() ? 1000 : 0;
  double const begin = times.at(times.first), end = times.at(times.steps);
  double largest = 0;
  for (int i = 0; i <= samples; ++i) {
    double const t = samples == 0 ? 0 : begin + (end - begin) * i / samples;
    try {
      auto const h = vector(t);
      largest = std::max(largest, std::hypot(h.x, h.y, h.z));
    } catch (NumbersFailed const&) {
      throw io::scene_error(scene, key,
                            fmt::format("is not finite at t = {}; accepted: finite numbers for all "
                                        "of the run",
                                        time_text(scene.units, t)));
    }
  }
  for (auto const& [of, length] : features.largest)
    if (of == key && length > 1.001 * largest) largest = length;
  return largest;
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), largest = -least;

  void include(double value) {
    least = std::min(least, value);
    largest = std::max(largest, value);
  }
  double magnitude() const { return std::max(-least, largest); }
};

// Calls work(box) for a few planes at a time, because a rank may have memory only for its part.
template <class Work>
void for_each_box(io::Scene const& scene, Work const& work) {
  io::for_each_box_of_planes(scene.lattice.shape, sizeof(double), work);
}

Range range_of_sites(io::Scene const& scene, io::SiteNumbers const& numbers, std::string_view key) {
  Range range;
  for_each_box(scene, [&](io::SiteBox const& box) {
    for (double const value : io::numbers_of_sites(scene, numbers, key, box)) range.include(value);
  });
  return range;
}

// Returns the range of the moments of all sites that are not vacant.
Range range_of_moments(io::Scene const& scene) {
  Range range;
  for_each_box(scene, [&](io::SiteBox const& box) {
    auto const occupied = io::occupied(scene, box);
    auto const moments = io::moments_of_sites(scene, box);
    for (std::size_t site = 0; site < moments.size(); ++site)
      if (occupied.empty() || occupied[site]) range.include(moments[site]);
  });
  return range;
}

double least_moment(io::Scene const& scene) {
  return scene.lattice.moments_of_sites.there() ? range_of_moments(scene).least : 1;
}

// If each site has its own moment, returns the largest of_bonds(|number|, `largest`) / moment over
// the occupied sites; otherwise of_bonds(`largest`, `largest`). `largest`: the largest |number|.
template <class OfBonds>
double largest_over_moments(io::Scene const& scene, io::SiteNumbers const& numbers,
                            std::string_view key, double largest, OfBonds const& of_bonds) {
  if (!scene.lattice.moments_of_sites.there()) return of_bonds(largest, largest);
  Range range;
  for_each_box(scene, [&](io::SiteBox const& box) {
    auto const occupied = io::occupied(scene, box);
    auto const moments = io::moments_of_sites(scene, box);
    auto const values = io::numbers_of_sites(scene, numbers, key, box);
    for (std::size_t site = 0; site < moments.size(); ++site)
      if (occupied.empty() || occupied[site])
        range.include(of_bonds(std::abs(values[site]), largest) / moments[site]);
  });
  return range.magnitude();
}

// The exchange of a bond is the harmonic mean of the constants at its ends: at most twice the
// smaller one.
double largest_exchange(io::Scene const& scene) {
  constexpr auto key = "field.exchange";
  auto const& numbers = scene.field.exchange_factors;
  auto const range = range_of_sites(scene, numbers, key);
  if (range.least < 0 && range.largest > 0)
    throw io::scene_error(scene, numbers.key_or(key),
                          "the constants must all have the same sign, as the harmonic mean of a "
                          "positive and a negative one is no bond; accepted: all numbers >= 0, or "
                          "all <= 0");
  double factor = 1;
  for (auto const& between : scene.field.exchange_between)
    factor = std::max(factor, std::abs(between.factor));
  return factor *
         largest_over_moments(scene, numbers, key, range.magnitude(),
                              [](double own, double all) { return std::min(2 * own, all); });
}

double largest_dmi(io::Scene const& scene) {
  constexpr auto key = "field.dmi";
  auto const& numbers = scene.field.dmi_factors;
  return largest_over_moments(scene, numbers, key, range_of_sites(scene, numbers, key).magnitude(),
                              [](double own, double all) { return (own + all) / 2; });
}

double largest_constant(io::Scene const& scene, double constant, io::SiteNumbers const& numbers) {
  constexpr auto key = "field.anisotropy";
  if (!numbers.there()) return constant == 0 ? 0 : std::abs(constant) / least_moment(scene);
  return largest_over_moments(scene, numbers, key, range_of_sites(scene, numbers, key).magnitude(),
                              [](double own, double) { return own; });
}

double largest_anisotropy(io::Scene const& scene, io::Anisotropy const& term) {
  return largest_constant(scene, term.constant, term.factors) +
         3 * largest_constant(scene, term.constant2, term.factors2);
}

// Both neighbours along each axis count; a biquadratic bond counts like a bilinear one with four
// times its constant.
double largest_interlayer(io::Scene const& scene, Lattice const& lattice) {
  double largest = 0, faces = 0;
  for (auto const& bond : scene.field.interlayers)
    largest = std::max(largest, std::abs(bond.bilinear) + 4 * std::abs(bond.biquadratic));
  for (int axis = 0; axis < 3; ++axis)
    if (lattice.has_neighbors(axis)) faces += 2 / lattice.spacing[axis];
  return faces * largest / least_moment(scene);
}

// The factors of the constants are bounds on the second derivatives of E on the sphere.
double largest_crystal_anisotropy(io::Scene const& scene, io::CrystalAnisotropy const& term) {
  double const of_first = term.hexagonal ? 36 : 2;
  return of_first * largest_constant(scene, term.constant, term.factors) +
         largest_constant(scene, term.constant2, term.factors2);
}

/// Largest magnitudes of the factors in [field.in_time].
struct LargestFactors {
  double exchange = 1, anisotropy = 1, dmi = 1;
};

LargestFactors largest_factors(io::Scene const& scene, Times const& times,
                               TimeFeatures const& features) {
  auto const of = [&](io::AppliedComponent const& factor, char const* key) {
    return largest(AppliedField({factor, 0.0, 0.0}, key), key, scene, times, features);
  };
  auto const& [exchange, anisotropy, dmi] = scene.field.in_time;
  return {of(exchange, "field.in_time.exchange"), of(anisotropy, "field.in_time.anisotropy"),
          of(dmi, "field.in_time.dmi")};
}

// Returns an upper bound on |H| due to the terms with site-dependent constants and to interlayers.
double bound_of_numbers(io::Scene const& scene, Lattice const& lattice,
                        LargestFactors const& factors) {
  auto const& field = scene.field;
  double bound = 0;
  if (field.exchange_factors.there())
    bound += factors.exchange * field.exchange->field_bound(lattice) * largest_exchange(scene);
  if (field.dmi_factors.there()) {
    double const largest = factors.dmi * largest_dmi(scene);
    for (int axis = 0; axis < (field.d2d_dmi ? 2 : 3); ++axis)
      if (lattice.has_neighbors(axis)) bound += 2 * largest / lattice.spacing[axis];
  }
  for (auto const& term : field.anisotropies)
    if (!term.is_plain()) bound += factors.anisotropy * largest_anisotropy(scene, term);
  for (auto const& term : field.crystal_anisotropies)
    if (!term.is_plain()) bound += factors.anisotropy * largest_crystal_anisotropy(scene, term);
  if (!field.interlayers.empty()) bound += largest_interlayer(scene, lattice);
  return bound;
}

// Returns the couplings whose sites both have a spin.
std::vector<Coupling> couplings_of_spins(io::Scene const& scene) {
  auto couplings = io::couplings(scene);
  std::erase_if(couplings, [&](Coupling const& bond) {
    return std::ranges::any_of(bond.between, [&](int site) {
      return io::of_cell_site(scene.lattice.moments, static_cast<std::size_t>(site)) == 0;
    });
  });
  return couplings;
}

double largest_gyromagnetic_of_sites(io::Scene const& scene) {
  if (!scene.lattice.gyromagnetic_of_sites.there()) return 1;
  Range range;
  for_each_box(scene, [&](io::SiteBox const& box) {
    for (double const ratio : io::gyromagnetic_of_sites(scene, box)) range.include(ratio);
  });
  return range.largest;
}

double largest_gyromagnetic(io::Lattice const& lattice) {
  double largest = 0;
  for (std::size_t site = 0; site < lattice.basis.size(); ++site)
    if (io::of_cell_site(lattice.moments, site) > 0)
      largest = std::max(largest, io::of_cell_site(lattice.gyromagnetic, site));
  return largest;
}

// Returns an upper bound on |H| times the gyromagnetic ratio at any site of a cell, without applied
// fields. `of_all`: the bound on -dE/dm due to terms that all sites have. `of_moments`: the bound
// on the field that moments of 1 create.
double bound_of_sites(io::Scene const& scene, Lattice const& lattice, double of_all,
                      double of_moments, LargestFactors const& factors) {
  auto const field = io::without_numbers_of_sites(scene.field);
  bool const has_own_moments = scene.lattice.moments_of_sites.there();
  auto const moments = has_own_moments ? range_of_moments(scene) : Range{1, 1};
  double const of_numbers = bound_of_numbers(scene, lattice, factors);
  cayspin::detail::BondLists const bonds(lattice, couplings_of_spins(scene));
  double largest = 0;
  for (std::size_t site = 0; site < bonds.field_bounds.size(); ++site) {
    double bound = of_all + bonds.field_bounds[site];
    auto const add = [&](int of, double constant) {
      if (of < 0 || of == static_cast<int>(site)) bound += std::abs(constant);
    };
    for (auto const& term : field.anisotropies) add(term.site, factors.anisotropy * term.constant);
    for (auto const& term : field.crystal_anisotropies)
      if (term.is_plain()) add(term.site, factors.anisotropy * 2 * term.constant);
    bound = bound / moments.least + of_numbers + of_moments * moments.largest;
    double const turning = bound * io::of_cell_site(scene.lattice.gyromagnetic, site);
    largest = std::max(largest, io::over_moment(scene.lattice, site, turning));
  }
  return largest;
}

// Returns the largest |mu0 * profile| of a source.
double largest_profile(io::Scene const& scene, io::SiteVectors const& profile) {
  double largest = 0;
  io::for_each_box_of_planes(scene.lattice.shape, 3 * sizeof(double), [&](io::SiteBox const& box) {
    auto const vectors = io::vectors_of_sites(scene, profile, "field.sources", box);
    for (std::size_t i = 0; i < vectors.size(); i += 3)
      largest = std::max(largest, std::hypot(vectors[i], vectors[i + 1], vectors[i + 2]));
  });
  return std::abs(scene.field.mu0) * largest;
}

// features.largest has an entry for each source that depends on t, in the order of the sources.
double bound_of_sources(io::Scene const& scene, Times const& times, TimeFeatures const& features) {
  constexpr auto key = "field.sources";
  auto const is_of_source = [](auto const& entry) { return entry.first == key; };
  auto of_sources = std::views::filter(features.largest, is_of_source);
  auto next = of_sources.begin();
  double bound = 0;
  for (auto const& [profile, time] : scene.field.sources) {
    AppliedField const factor({time, 0.0, 0.0}, key);
    TimeFeatures own;
    if (factor.depends_on_time() && next != of_sources.end()) own.largest = {*next++};
    bound += largest_profile(scene, profile) * largest(factor, key, scene, times, own);
  }
  return bound;
}

// The damping-like term has its largest factor, lambda^2, where the spin is opposite to p.
double slonczewski_bound(io::Scene const& scene, io::Slonczewski const& torque, Times const& times,
                         TimeFeatures const& features) {
  constexpr auto key = "torque.slonczewski";
  auto const largest_of = [&](io::AppliedComponent const& a, io::AppliedComponent const& b) {
    return largest(AppliedField({a, b, 0.0}, key), key, scene, times, features);
  };
  if (torque.is_plain()) return largest_of(torque.damping_like, torque.field_like);
  auto const of_sites = [&](io::SiteNumbers const& numbers, bool per_moment) {
    double const strength = numbers.there() ? range_of_sites(scene, numbers, key).magnitude() : 1;
    return per_moment ? strength / least_moment(scene) : strength;
  };
  return torque.lambda * torque.lambda *
             of_sites(torque.damping_like_of_sites, torque.damping_like_per_moment) *
             largest_of(torque.damping_like, 0.0) +
         of_sites(torque.field_like_of_sites, torque.field_like_per_moment) *
             largest_of(0.0, torque.field_like);
}

double torque_bound(io::Scene const& scene, Lattice const& lattice, Times const& times,
                    TimeFeatures const& features) {
  auto const& torque = scene.field.torque;
  double bound = 0;
  if (auto const& of = torque.zhang_li) {
    constexpr auto key = "torque.zhang_li.velocity";
    double const velocity = largest(AppliedField(of->velocity, key), key, scene, times, features);
    for (int axis = 0; axis < 3; ++axis)
      if (lattice.has_neighbors(axis)) bound += velocity / lattice.spacing[axis];
    bound *= std::hypot(1, of->nonadiabaticity);
    if (of->per_moment) bound /= least_moment(scene);
  }
  if (auto const& of = torque.slonczewski) {
    // If gamma differs from site to site, strengths in T turn each spin by the gamma of its site.
    bool const are_fields = scene.material && scene.material->gamma_factors.there();
    bound += (are_fields ? largest_gyromagnetic_of_sites(scene) : 1) *
             slonczewski_bound(scene, *of, times, features);
  }
  return bound;
}

}  // namespace

double bound_of_dipoles(io::Scene const& scene, Lattice const& lattice) {
  auto const& demag = scene.field.demag;
  if (!demag || !demag->dipoles) return 0;
  std::vector<double> moments(scene.lattice.basis.size(), 1);
  for (std::size_t site = 0; site < moments.size(); ++site)
    moments[site] = io::of_cell_site(scene.lattice.moments, site);
  if (scene.lattice.moments_of_sites.there())
    std::ranges::fill(moments, range_of_moments(scene).largest);
  return std::abs(scene.field.mu0 * demag->strength) *
         dipolar_bound(lattice, *demag->dipoles, moments, demag->periodic_images);
}

double least_damping(io::Scene const& scene) {
  auto const& system = scene.system;
  return system.dampings.there() ? range_of_sites(scene, system.dampings, "system.damping").least
                                 : system.damping;
}

double largest_damping(io::Scene const& scene) {
  auto const& system = scene.system;
  if (!system.dampings.there()) return system.damping;
  auto const range = range_of_sites(scene, system.dampings, "system.damping");
  if (range.least < 0)
    throw io::scene_error(scene, system.dampings.key_or("system.damping"),
                          "is negative at a site; accepted: numbers >= 0");
  return range.largest;
}

double field_bound(io::Scene const& scene, Lattice const& lattice, Times const& times,
                   TimeFeatures const& features) {
  auto const field = io::without_numbers_of_sites(scene.field);
  auto const factors = largest_factors(scene, times, features);
  double bound = 0;
  io::for_each_lattice_term(field, [&]<class Term>(std::optional<Term> const& term) {
    constexpr bool is_exchange = std::is_same_v<Term, io::Exchange>;
    if (term) bound += (is_exchange ? factors.exchange : factors.dmi) * term->field_bound(lattice);
  });
  double of_moments = 0;
  if (field.slab_demag) of_moments += std::abs(field.mu0 * field.slab_demag->strength);
  if (field.demag && !field.demag->dipoles)
    of_moments += std::abs(field.mu0 * field.demag->strength);
  double const applied = largest(AppliedField(field), "field.applied", scene, times, features) +
                         bound_of_dipoles(scene, lattice);
  if (!io::needs_pass(scene)) {
    for (auto const& term : field.anisotropies) bound += std::abs(term.constant);
    return bound + of_moments + applied;
  }
  return largest_gyromagnetic_of_sites(scene) *
             (bound_of_sites(scene, lattice, bound, of_moments, factors) +
              largest_gyromagnetic(scene.lattice) *
                  (applied + bound_of_sources(scene, times, features))) +
         torque_bound(scene, lattice, times, features);
}

double largest_rate(io::Scene const& scene, Lattice const& lattice, Times const& times,
                    TimeFeatures const& features) {
  auto const& system = scene.system;
  if (system.kind == io::SystemKind::llg)
    return field_bound(scene, lattice, times, features) *
           std::hypot(largest_damping(scene), system.precession);
  double largest = 0;
  if (std::holds_alternative<io::InertiaFile>(system.inertia)) return largest;
  for (auto const& [xx, yy, zz, xy, xz, yz] : io::inverse_inertia(scene))
    largest = std::max({largest, std::abs(xx) + std::abs(xy) + std::abs(xz),
                        std::abs(xy) + std::abs(yy) + std::abs(yz),
                        std::abs(xz) + std::abs(yz) + std::abs(zz)});
  return largest;
}

}  // namespace cayspin::simulation
