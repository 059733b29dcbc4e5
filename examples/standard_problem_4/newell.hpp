// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "tensor.hpp"

#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace newell {

// Sums of these functions cancel to about (size / distance)^6: long double keeps their digits.
using Number = long double;

/// factor times asinh(a / b) or atan(a / b), and 0 at b = 0, where the factor vanishes.
inline Number asinh_term(Number factor, Number a, Number b) {
  return b > 0 ? factor * std::asinh(a / b) : 0;
}
inline Number atan_term(Number factor, Number a, Number b) {
  return b != 0 ? factor * std::atan(a / b) : 0;
}

/// Newell, Williams and Dunlop 1993, eq. 27: the interaction along x.
inline Number f(Number x, Number y, Number z) {
  Number const xx = x * x, yy = y * y, zz = z * z, r = std::sqrt(xx + yy + zz);
  return asinh_term(y * (zz - xx) / 2, y, std::sqrt(xx + zz)) +
         asinh_term(z * (yy - xx) / 2, z, std::sqrt(xx + yy)) - atan_term(x * y * z, y * z, x * r) +
         (2 * xx - yy - zz) * r / 6;
}

/// The same, eq. 32: between x and y.
inline Number g(Number x, Number y, Number z) {
  Number const xx = x * x, yy = y * y, zz = z * z, r = std::sqrt(xx + yy + zz);
  return asinh_term(x * y * z, z, std::sqrt(xx + yy)) +
         asinh_term(y * (3 * zz - yy) / 6, x, std::sqrt(yy + zz)) +
         asinh_term(x * (3 * zz - xx) / 6, y, std::sqrt(xx + zz)) -
         atan_term(z * zz / 6, x * y, z * r) - atan_term(z * yy / 2, x * z, y * r) -
         atan_term(z * xx / 2, y * z, x * r) - x * y * r / 3;
}

/// The second difference along each axis, at `distance` for a cell of `size`: 27 points.
template <class Function>
double difference(Function const& function, std::array<double, 3> const& distance,
                  std::array<double, 3> const& size) {
  constexpr std::array<int, 3> weight{-1, 2, -1};
  auto const at = [&](std::size_t axis, int step) {
    return static_cast<Number>(distance[axis]) + step * static_cast<Number>(size[axis]);
  };
  Number sum = 0;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k)
        sum += weight[static_cast<std::size_t>(i + 1)] * weight[static_cast<std::size_t>(j + 1)] *
               weight[static_cast<std::size_t>(k + 1)] * function(at(0, i), at(1, j), at(2, k));
  Number const volume = static_cast<Number>(size[0]) * size[1] * size[2];
  return static_cast<double>(sum / (4 * std::numbers::pi_v<Number> * volume));
}

/// Exact for uniformly magnetized cells.
inline Tensor tensor(std::array<double, 3> const& position, std::array<double, 3> const& size) {
  auto const [x, y, z] = position;
  auto const [dx, dy, dz] = size;
  return {difference(f, {x, y, z}, {dx, dy, dz}), difference(f, {y, x, z}, {dy, dx, dz}),
          difference(f, {z, y, x}, {dz, dy, dx}), difference(g, {x, y, z}, {dx, dy, dz}),
          difference(g, {x, z, y}, {dx, dz, dy}), difference(g, {y, z, x}, {dy, dz, dx})};
}

}  // namespace newell
