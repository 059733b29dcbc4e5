// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "largest_field.hpp"

#include "applied_field.hpp"
#include "failure.hpp"
#include "io/site_box.hpp"
#include "text.hpp"

#include <cayspin/field/bonds_of_sites.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <string_view>
#include <vector>

namespace cayspin::simulation {
namespace {

// The largest length of a vector at 1001 equal times of the run. A pulse that they miss is among
// the features.
double largest(AppliedField const& vector, std::string_view key, io::Scene const& scene,
               Times const& times, TimeFeatures const& features) {
  if (!vector.present()) return 0;
  int const samples = vector.depends_on_time() ? 1000 : 0;
  double const end = times.at(times.steps);
  double largest = 0;
  for (int i = 0; i <= samples; ++i) {
    double const t = samples == 0 ? 0 : end * i / samples;
    try {
      auto const h = vector(t);
      largest = std::max(largest, std::hypot(h.x, h.y, h.z));
    } catch (NumbersFailed const& error) {
      if (!scene.units.si) throw io::scene_error(scene, key, error.what());
      throw io::scene_error(scene, key, "is not finite at t = " + time_text(scene.units, t));
    }
  }
  for (auto const& [of, length] : features.largest)
    if (of == key && length > 1.001 * largest) largest = length;
  return largest;
}

struct Range {
  double least = std::numeric_limits<double>::infinity(), largest = -least;

  double magnitude() const { return std::max(-least, largest); }
};

// The range over all sites, by some planes at once: a rank has no room for more than its part.
Range range_of_sites(io::Scene const& scene, io::SiteNumbers const& numbers, std::string_view key) {
  auto const& shape = scene.lattice.shape;
  auto const at_once = io::planes_to_read(shape, sizeof(double));
  Range range;
  for (std::int64_t first = 0; first < shape[2]; first += at_once) {
    auto const planes = std::min(at_once, shape[2] - first);
    for (double const value :
         io::numbers_of_sites(scene, numbers, key, {{0, 0, first}, {shape[0], shape[1], planes}}))
      range = {std::min(range.least, value), std::max(range.largest, value)};
  }
  return range;
}

double largest_of_sites(io::Scene const& scene, io::SiteNumbers const& numbers,
                        std::string_view key) {
  return range_of_sites(scene, numbers, key).magnitude();
}

double largest_exchange(io::Scene const& scene) {
  constexpr auto key = "field.exchange";
  auto const range = range_of_sites(scene, scene.field.exchange_factors, key);
  if (range.least < 0 && range.largest > 0)
    throw io::scene_error(scene, scene.field.exchange_factors.key_or(key),
                          "the constants must have one sign, as the harmonic mean of a positive "
                          "and a negative one is no bond");
  return range.magnitude();
}

// Of terms whose constants differ from site to site.
double bound_of_numbers(io::Scene const& scene, Lattice const& lattice) {
  auto const& field = scene.field;
  double bound = 0;
  if (field.exchange_factors.there())
    bound += field.exchange->field_bound(lattice) * largest_exchange(scene);
  if (field.dmi_factors.there())
    for (int axis = 0; axis < 3; ++axis)
      if (lattice.has_neighbors(axis))
        bound +=
            2 * largest_of_sites(scene, field.dmi_factors, "field.dmi") / lattice.spacing[axis];
  for (auto const& term : field.anisotropies)
    if (term.factors.there()) bound += largest_of_sites(scene, term.factors, "field.anisotropy");
  return bound;
}

// Those between sites that have a spin.
std::vector<Coupling> couplings_of_spins(io::Scene const& scene) {
  auto couplings = io::couplings(scene);
  std::erase_if(couplings, [&](Coupling const& bond) {
    return std::ranges::any_of(bond.between, [&](int site) {
      return io::of_cell_site(scene.lattice.moments, static_cast<std::size_t>(site)) == 0;
    });
  });
  return couplings;
}

double largest_gyromagnetic(io::Lattice const& lattice) {
  double largest = 0;
  for (std::size_t site = 0; site < lattice.basis.size(); ++site)
    if (io::of_cell_site(lattice.moments, site) > 0)
      largest = std::max(largest, io::of_cell_site(lattice.gyromagnetic, site));
  return largest;
}

// Of the terms that have sites of their own: the largest of the sites of a cell.
double bound_of_sites(io::Scene const& scene, Lattice const& lattice, double of_all) {
  auto const field = io::without_numbers_of_sites(scene.field);
  of_all += bound_of_numbers(scene, lattice);
  cayspin::detail::BondLists const bonds(lattice, couplings_of_spins(scene));
  double largest = 0;
  for (std::size_t site = 0; site < bonds.field_bounds.size(); ++site) {
    double bound = of_all + bonds.field_bounds[site];
    auto const add = [&](int of, double constant) {
      if (of < 0 || of == static_cast<int>(site)) bound += std::abs(constant);
    };
    for (auto const& term : field.anisotropies) add(term.site, term.constant);
    for (auto const& term : field.cubic_anisotropies) add(term.site, 2 * term.constant);
    double const turning = bound * io::of_cell_site(scene.lattice.gyromagnetic, site);
    largest = std::max(largest, io::over_moment(scene.lattice, site, turning));
  }
  return largest;
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
  }
  if (auto const& of = torque.slonczewski) {
    constexpr auto key = "torque.slonczewski";
    bound += largest(AppliedField({of->damping_like, of->field_like, 0.0}, key), key, scene, times,
                     features);
  }
  return bound;
}

}  // namespace

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
  double bound = 0;
  io::for_each_lattice_term(field, [&](auto const& term) {
    if (term) bound += term->field_bound(lattice);
  });
  if (field.slab_demag) bound += std::abs(field.mu0 * field.slab_demag->strength);
  if (field.demag) bound += std::abs(field.mu0 * field.demag->strength);
  double const applied = largest(AppliedField(field), "field.applied", scene, times, features);
  if (!io::needs_pass(scene)) {
    for (auto const& term : field.anisotropies) bound += std::abs(term.constant);
    return bound + applied;
  }
  return bound_of_sites(scene, lattice, bound) + largest_gyromagnetic(scene.lattice) * applied +
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
