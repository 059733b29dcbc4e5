// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/tensor.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

/// The demagnetising tensor by mumax3's quadrature (Vansteenkiste et al. 2014, Sec. II.E) with its
/// default accuracy: the mean, over points in one cell, of the field of point charges on the faces
/// of the other cell. Its error is up to 2.5e-4.
namespace quadrature {

constexpr double accuracy = 6;  // gap between the cells / edge of a piece of a cell

/// Returns the middle of piece `index` of `pieces` pieces of an edge.
inline double middle(double edge, int pieces, int index) {
  return edge * ((index + 0.5) / pieces - 0.5);
}

inline cayspin::DemagnetizingTensor tensor(std::array<double, 3> const& distance,
                                           std::array<double, 3> const& size) {
  // The gap between the nearest faces; if the cells touch, their shortest edge instead.
  double gap = 0;
  for (std::size_t a = 0; a < 3; ++a)
    gap = std::hypot(gap, std::max(std::abs(distance[a]) - size[a], 0.0));
  if (gap < 1e-9 * size[0]) gap = *std::min_element(size.begin(), size.end());
  std::array<int, 3> pieces{};
  for (std::size_t a = 0; a < 3; ++a)
    pieces[a] = static_cast<int>(std::max(size[a] * accuracy / gap, 1.0) + 0.5);

  std::array<std::array<double, 3>, 3> n{};  // [direction of m][component of -H]
  for (std::size_t u = 0; u < 3; ++u) {
    std::size_t const v = (u + 1) % 3, w = (u + 2) % 3;
    // Along each edge there are twice as many charges as points: errors cancel because the grids
    // are staggered.
    int const along_v = 2 * pieces[v], along_w = 2 * pieces[w];
    double const charge =
        size[v] * size[w] /
        (4 * std::numbers::pi * along_v * along_w * pieces[0] * pieces[1] * pieces[2]);
    std::array<double, 3> point{};
    auto const add_charge = [&](double sign, double at_v, double at_w) {
      std::array<double, 3> r = point;
      r[u] -= 0.5 * sign * size[u];
      r[v] -= at_v;
      r[w] -= at_w;
      double const square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
      for (std::size_t c = 0; c < 3; ++c)
        n[u][c] -= sign * charge * r[c] / (square * std::sqrt(square));
    };
    for (int x = 0; x < pieces[0]; ++x)
      for (int y = 0; y < pieces[1]; ++y)
        for (int z = 0; z < pieces[2]; ++z) {
          point = {distance[0] + middle(size[0], pieces[0], x),
                   distance[1] + middle(size[1], pieces[1], y),
                   distance[2] + middle(size[2], pieces[2], z)};
          for (int i = 0; i < along_v; ++i)
            for (int j = 0; j < along_w; ++j)
              for (double const sign : {1.0, -1.0})
                add_charge(sign, middle(size[v], along_v, i), middle(size[w], along_w, j));
        }
  }
  return {n[0][0], n[1][1], n[2][2], n[0][1], n[0][2], n[1][2]};
}

}  // namespace quadrature
