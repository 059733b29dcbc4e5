// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/crystal.hpp>
#include <cayspin/demagnetization/dipole_images.hpp>
#include <cayspin/demagnetization/dipole_tensor.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/part.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace cayspin::inline v0_2 {

/// Returns an upper bound on the absolute eigenvalues of the matrix that turns the spins into H,
/// for a DipolarField with strength 1 and demagnetising factors from 0 to 1, on an open or periodic
/// lattice of any size. Stable steps depend on these eigenvalues; |H| at a site can be larger.
/// `moments`: one for each site of a cell; it multiplies the spin of that site. `periodic_images`:
/// as in the field's DipolarOptions; it matters only along axes with a single cell. The two parts
/// of Ewald's sum are bounded separately, for several ways to split the sum, and the smallest
/// result is returned. For large sc, bcc and fcc lattices it is about twice the largest eigenvalue.
/// Throws std::invalid_argument unless there is one moment for each site of a cell.
inline double dipolar_bound(Lattice const& lattice, Crystal crystal,
                            std::vector<double> const& moments,
                            std::array<int, 3> const& periodic_images = {}) {
  using namespace detail;
  if (moments.size() != crystal.basis.size())
    throw std::invalid_argument(
        "cayspin::dipolar_bound: there is not one moment for each site of a cell");
  std::vector<Point> places, cell;
  for (std::size_t site = 0; site < crystal.basis.size(); ++site)
    places.push_back(crystal.position({}, site));
  auto const scaled = [&](Point r) {
    for (std::size_t axis = 0; axis < 3; ++axis) r[axis] *= lattice.spacing[axis];
    return r;
  };
  double longest = 0;
  for (auto const& vector : crystal.cell) longest = std::max(longest, length(scaled(vector)));
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const extent = whole(lattice).shape[axis];
    auto const cells = axis == 2 ? extent / lattice.cell_sites : extent;
    auto const& vector = crystal.cell[axis];
    // The bound is that of an infinite lattice. For a single layer without images, any distance
    // between the layers of that lattice gives a bound.
    bool const repeats = cells > 1 || periodic_images[axis] != 0;
    cell.push_back(add_scaled(repeats ? 1 : longest / length(scaled(vector)), vector, {}));
  }
  std::ranges::transform(places, places.begin(), scaled);
  std::ranges::transform(cell, cell.begin(), scaled);
  PointsOfLattice const points(cell);
  double moment = 0;
  for (double const one : moments) moment += one;
  double best = std::numeric_limits<double>::infinity();
  double const per_site = points.measure() / static_cast<double>(places.size());
  for (double const division : {1.0, 1.3, 1.6, 2.0, 2.4}) {
    double const alpha = division / std::cbrt(per_site);
    double waves = 0;  // bound on the sum over wave numbers, for any mode
    points.reciprocal().for_each_within({}, 2 * ewald_reach * alpha, [&](Point const& g, auto&&) {
      waves += std::exp(-scalar_product(g, g) / (4 * alpha * alpha));
    });
    waves *= 4 * std::numbers::pi * moment / points.measure();
    double most = 0, least = 0;
    for (std::size_t site = 0; site < places.size(); ++site) {
      if (moments[site] == 0) continue;
      double const self = self_field_of_ewald(alpha) * moments[site];
      double near = 0;
      for (std::size_t other = 0; other < places.size(); ++other)
        points.for_each_within(add_scaled(-1, places[other], places[site]), ewald_reach / alpha,
                               [&](Point const& r, auto&&) {
                                 double const r2 = scalar_product(r, r);
                                 if (r2 == 0) return;
                                 ShortRangeDipole const part(r2, alpha);
                                 near += moments[other] *
                                         std::max(part.product * r2 + part.unit, -part.unit);
                               });
      most = std::max(most, near + self);
      least = std::max(least, near - self);
    }
    best = std::min(best, std::max(most, least + waves));
  }
  auto const [x, y, z] = lattice.spacing;
  return best * x * y * z / (4 * std::numbers::pi);
}

}  // namespace cayspin::inline v0_2
