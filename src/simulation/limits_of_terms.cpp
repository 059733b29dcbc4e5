// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "limits_of_terms.hpp"

#include "io/site_box.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::simulation {
namespace {

// Returns the largest ratio of an interlayer's strength to that of the exchange in the half cell
// beside it, for bonds along `axis` that start at the cells of `box`.
double largest_at_faces(io::Scene const& scene, io::SiteBox const& box, std::size_t axis,
                        std::int64_t range, double spacing) {
  constexpr auto key = "field.exchange";
  auto const& numbers = scene.field.exchange_at_faces;
  std::int64_t const reach = range + 1;
  auto const pairs = io::regions_across(scene, box, axis, reach);
  auto const own = io::numbers_of_sites(scene, numbers, key, box);
  auto const others = io::numbers_across(scene, numbers, key, box, axis, reach);
  double largest = 0;
  for (std::size_t site = 0; site < pairs.size(); ++site)
    for (auto const& bond : scene.field.interlayers) {
      if (bond.range != range || !std::ranges::is_permutation(bond.regions, pairs[site])) continue;
      double const strength = std::abs(bond.bilinear) + 4 * std::abs(bond.biquadratic);
      if (strength == 0) continue;
      for (double const exchange : {own[site], others[site]}) {
        if (exchange < 0)
          throw io::scene_error(scene, numbers.key_or(key),
                                "is negative beside an interlayer, whose spins at faces it ties to "
                                "the cells; accepted: numbers >= 0, or no interlayer");
        if (exchange > 0) largest = std::max(largest, strength * spacing / (2 * exchange));
      }
    }
  return largest;
}

void require_weak_interlayers(io::Scene const& scene, Lattice const& lattice) {
  if (!scene.field.exchange_at_faces.there()) return;
  std::vector<std::int64_t> ranges;
  for (auto const& bond : scene.field.interlayers) ranges.push_back(bond.range);
  std::ranges::sort(ranges);
  ranges.erase(std::ranges::unique(ranges).begin(), ranges.end());
  double ratio = 0;
  io::for_each_box_of_planes(scene.lattice.shape, 2 * sizeof(double), [&](io::SiteBox const& box) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      for (std::int64_t const range : ranges)
        if (range + 1 < lattice.shape[axis])
          ratio = std::max(ratio, largest_at_faces(scene, box, axis, range, lattice.spacing[axis]));
  });
  if (ratio > most_at_faces)
    throw io::scene_error(
        scene, "field.interlayer",
        fmt::format("is {:.3g} times the exchange of half a cell; accepted: at most 1/3: smaller "
                    "cells, or a larger exchange",
                    ratio));
}

}  // namespace

void require_limits_of_terms(io::Scene const& scene, Lattice const& lattice) {
  require_weak_interlayers(scene, lattice);
}

}  // namespace cayspin::simulation
