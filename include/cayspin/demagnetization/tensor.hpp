// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <map>
#include <numbers>
#include <vector>

namespace cayspin::inline v0_2 {

/// The symmetric demagnetising tensor N between two equal rectangular cells. If one has the uniform
/// magnetization m, its mean field in the other is H = -N m.
struct DemagnetizingTensor {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

using DemagnetizingTensors = std::vector<DemagnetizingTensor>;

/// Function that returns N for two cells. `position`: from the centre of one to that of the other.
/// `cell`: their edges.
using TensorOfCells = DemagnetizingTensor(std::array<double, 3> const& position,
                                          std::array<double, 3> const& cell);

/// Largest ratio between edges of a cell that DemagnetizingField accepts; the tensor is tested up
/// to this ratio.
inline constexpr double largest_edge_ratio = 1e9;

namespace detail {

using Lengths = std::array<double, 3>;

inline double norm(Lengths const& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }

template <class Tensor, class Number>
void add(Tensor& sum, Number weight, Tensor const& a) {
  sum.xx += weight * a.xx, sum.yy += weight * a.yy, sum.zz += weight * a.zz;
  sum.xy += weight * a.xy, sum.xz += weight * a.xz, sum.yz += weight * a.yz;
}

/// Newell's functions at one point: f for the diagonal entries, g for the others. They are long
/// double because most digits cancel in their second differences.
struct NewellFunctions {
  long double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;
};

/// Returns the functions of Newell, Williams and Dunlop 1993, eqs. 27 and 32, computed together
/// because they have asinh and atan terms in common.
inline NewellFunctions newell_functions(long double x, long double y, long double z) {
  using Number = long double;
  Number const x2 = x * x, y2 = y * y, z2 = z * z, xyz = x * y * z;
  Number const r = std::sqrt(x2 + y2 + z2);
  // These two return 0 where a denominator is 0. The factors that multiply them are 0 there, too.
  auto const asinh_of = [](Number a, Number b2) {
    return b2 > 0 ? std::asinh(a / std::sqrt(b2)) : 0;
  };
  auto const atan_of = [](Number a, Number b) { return b != 0 ? std::atan(a / b) : 0; };
  Number const sx = asinh_of(x, y2 + z2), sy = asinh_of(y, x2 + z2), sz = asinh_of(z, x2 + y2);
  Number const tx = atan_of(y * z, x * r), ty = atan_of(x * z, y * r), tz = atan_of(x * y, z * r);
  return {
      .xx = (y * (z2 - x2) * sy + z * (y2 - x2) * sz) / 2 - xyz * tx + (2 * x2 - y2 - z2) * r / 6,
      .yy = (x * (z2 - y2) * sx + z * (x2 - y2) * sz) / 2 - xyz * ty + (2 * y2 - x2 - z2) * r / 6,
      .zz = (x * (y2 - z2) * sx + y * (x2 - z2) * sy) / 2 - xyz * tz + (2 * z2 - x2 - y2) * r / 6,
      .xy = xyz * sz + (y * (3 * z2 - y2) * sx + x * (3 * z2 - x2) * sy) / 6 -
            z * (3 * (x2 * tx + y2 * ty) + z2 * tz) / 6 - x * y * r / 3,
      .xz = xyz * sy + (z * (3 * y2 - z2) * sx + x * (3 * y2 - x2) * sz) / 6 -
            y * (3 * (x2 * tx + z2 * tz) + y2 * ty) / 6 - x * z * r / 3,
      .yz = xyz * sx + (z * (3 * x2 - z2) * sy + y * (3 * x2 - y2) * sz) / 6 -
            x * (3 * (y2 * ty + z2 * tz) + x2 * tx) / 6 - y * z * r / 3,
  };
}

/// Returns the tensor from second differences of Newell's functions along all three axes, which
/// take 27 points.
inline DemagnetizingTensor near_demagnetizing_tensor(Lengths const& position, Lengths const& cell) {
  using Number = long double;
  NewellFunctions sum;
  for (int i = -1; i <= 1; ++i)
    for (int j = -1; j <= 1; ++j)
      for (int k = -1; k <= 1; ++k) {
        int const weight = (i == 0 ? 2 : -1) * (j == 0 ? 2 : -1) * (k == 0 ? 2 : -1);
        add(sum, weight,
            newell_functions(position[0] + i * Number(cell[0]), position[1] + j * Number(cell[1]),
                             position[2] + k * Number(cell[2])));
      }
  Number const divisor = 4 * std::numbers::pi_v<Number> * cell[0] * cell[1] * cell[2];
  auto const entry = [&](Number a) { return static_cast<double>(a / divisor); };
  return {entry(sum.xx), entry(sum.yy), entry(sum.zz), entry(sum.xy), entry(sum.xz), entry(sum.yz)};
}

template <std::size_t Size>
constexpr std::array<double, Size> factorials() {
  std::array<double, Size> result{1};
  for (std::size_t n = 1; n < Size; ++n) result[n] = static_cast<double>(n) * result[n - 1];
  return result;
}

/// Returns coefficients of the Taylor series of second differences. The second difference along x,
/// divided by h_x^2, is d_x^2 times the sum over i of 2 * h_x^(2 * i) / (2 * i + 2)! * d_x^(2 * i),
/// with the edge h_x and the derivative d_x. This sum is multiplied by the sums along y and z. The
/// product of the three acts on derivatives of 1/r, for which d_z^2 = -(d_x^2 + d_y^2). Element
/// [m][i] of the result is the coefficient of d_x^(2 * i) * d_y^(2 * j) in the product, with
/// j = m - i.
template <std::size_t HalfOrder>
std::array<std::array<double, HalfOrder + 1>, HalfOrder + 1> difference_series(Lengths const& h) {
  constexpr auto factorial = factorials<2 * HalfOrder + 3>();
  std::array<std::array<double, HalfOrder + 1>, 3> w{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double power = 2;
    for (std::size_t i = 0; i <= HalfOrder; ++i, power *= h[axis] * h[axis])
      w[axis][i] = power / factorial[2 * i + 2];
  }
  std::array<std::array<double, HalfOrder + 1>, HalfOrder + 1> series{};
  for (std::size_t m = 0; m <= HalfOrder; ++m) {
    auto& row = series[m];
    row[0] = w[2][m];
    for (std::size_t n = 1; n <= m; ++n) {  // Horner's rule: row *= -(d_x^2 + d_y^2)
      for (std::size_t i = n; i > 0; --i)
        row[i] = w[2][m - n] * w[0][i] * w[1][n - i] - row[i] - row[i - 1];
      row[0] = w[2][m - n] * w[1][n] - row[0];
    }
  }
  return series;
}

/// Returns the tensor by its Taylor series in edge / distance, up to `Order`. Order 0 is the field
/// of a dipole.
template <std::size_t Order>
DemagnetizingTensor far_demagnetizing_tensor(Lengths const& position, Lengths const& cell,
                                             double distance) {
  constexpr auto factorial = factorials<Order + 3>();
  auto const [x, y, z] =
      Lengths{position[0] / distance, position[1] / distance, position[2] / distance};
  Lengths const h{cell[0] / distance, cell[1] / distance, cell[2] / distance};
  auto const series = difference_series<Order / 2>(h);

  // Taylor coefficients b_n = d^n (1/r) / n! at r = 1, for multi-indices n of the last three
  // degrees: `even` holds n = (i, degree - i, 0), `odd` holds n = (i, degree - i - 1, 1). Zeros
  // surround both. The recurrence is |n| b_n + (2 |n| - 1) sum_a x_a b_(n - e_a) + (|n| - 1) sum_a
  // b_(n - 2 e_a) = 0, with the unit vectors e_a.
  constexpr std::size_t pad = 2;
  using Numbers = std::array<double, Order + 3 + 2 * pad>;
  std::array<Numbers, 3> even{}, odd{};
  even[0][pad] = 1;
  DemagnetizingTensor sum;
  for (std::size_t n = 1; n <= Order + 2; ++n) {
    double const first = -static_cast<double>(2 * n - 1) / static_cast<double>(n);
    double const second = -static_cast<double>(n - 1) / static_cast<double>(n);
    Numbers const &e1 = even[(n + 2) % 3], &e2 = even[(n + 1) % 3];
    Numbers const &o1 = odd[(n + 2) % 3], &o2 = odd[(n + 1) % 3];
    Numbers &e = even[n % 3], &o = odd[n % 3];
    for (std::size_t i = pad; i <= n + pad; ++i)
      e[i] = first * (x * e1[i - 1] + y * e1[i]) + second * (e2[i - 2] + e2[i]);
    for (std::size_t i = pad; i < n + pad; ++i)
      o[i] = first * (x * o1[i - 1] + y * o1[i] + z * e1[i]) + second * (o2[i - 2] + o2[i]);
    if (n % 2 == 1) continue;
    std::size_t const m = n / 2 - 1;
    for (std::size_t i = 0, j = m; i <= m; ++i, --j) {
      double const c = series[m][i];
      double const* b = &e[pad + 2 * i];
      double const* b1 = &o[pad + 2 * i];
      sum.xx += c * factorial[2 * i + 2] * factorial[2 * j] * b[2];
      sum.yy += c * factorial[2 * i] * factorial[2 * j + 2] * b[0];
      sum.xy += c * factorial[2 * i + 1] * factorial[2 * j + 1] * b[1];
      sum.xz += c * factorial[2 * i + 1] * factorial[2 * j] * b1[1];
      sum.yz += c * factorial[2 * i] * factorial[2 * j + 1] * b1[0];
    }
  }
  double const scale = -h[0] * h[1] * h[2] / (4 * std::numbers::pi);
  return {scale * sum.xx, scale * sum.yy, -scale * (sum.xx + sum.yy),
          scale * sum.xy, scale * sum.xz, scale * sum.yz};
}

inline DemagnetizingTensor divided_demagnetizing_tensor(Lengths const& position,
                                                        Lengths const& cell);
inline DemagnetizingTensor slender_demagnetizing_tensor(Lengths const& position,
                                                        Lengths const& cell);

/// Returns the tensor by the cheapest method that is accurate at this distance.
inline DemagnetizingTensor cheapest_demagnetizing_tensor(Lengths const& position,
                                                         Lengths const& cell) {
  double const edge = std::max({cell[0], cell[1], cell[2]}), distance = norm(position);
  if (distance >= 50 * edge) return far_demagnetizing_tensor<6>(position, cell, distance);
  if (distance >= 8 * edge) return far_demagnetizing_tensor<12>(position, cell, distance);
  if (distance >= 4 * edge) return far_demagnetizing_tensor<22>(position, cell, distance);
  if (edge > 1000 * std::min({cell[0], cell[1], cell[2]}))
    return slender_demagnetizing_tensor(position, cell);
  // The rounding error of second differences is proportional to the square of `loss`. Cells that
  // are very close are not divided, since they would need too many pieces.
  double const reach = distance + edge;
  double const loss = (distance / cell[0]) * (reach / cell[1]) * (reach / cell[2]);
  if (loss > 6000 && 100 * distance > edge) return divided_demagnetizing_tensor(position, cell);
  return near_demagnetizing_tensor(position, cell);
}

/// Divides both cells into pieces whose edges are at most a fifth of the distance. Returns the
/// tensors between the pieces, summed over the pieces of one cell and averaged over those of the
/// other.
inline DemagnetizingTensor divided_demagnetizing_tensor(Lengths const& position,
                                                        Lengths const& cell) {
  std::array<int, 3> pieces{};
  Lengths piece{};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    pieces[axis] = static_cast<int>(std::ceil(5 * cell[axis] / norm(position)));
    piece[axis] = cell[axis] / pieces[axis];
  }
  auto const [nx, ny, nz] = pieces;
  DemagnetizingTensor sum;
  for (int i = 1 - nx; i < nx; ++i)
    for (int j = 1 - ny; j < ny; ++j)
      for (int k = 1 - nz; k < nz; ++k) {
        int const pairs = (nx - std::abs(i)) * (ny - std::abs(j)) * (nz - std::abs(k));
        Lengths const at{position[0] + i * piece[0], position[1] + j * piece[1],
                         position[2] + k * piece[2]};
        add(sum, 1. * pairs / (nx * ny * nz), cheapest_demagnetizing_tensor(at, piece));
      }
  return sum;
}

/// Returns the tensor of slender cells: halves the longest edge until no edge exceeds 16 times the
/// shortest. Pairs of pieces that are already far apart are summed immediately, so that few pairs
/// remain to be halved.
inline DemagnetizingTensor slender_demagnetizing_tensor(Lengths const& position,
                                                        Lengths const& cell) {
  using Offset = std::array<std::int64_t, 3>;  // between the pieces of a pair, in pieces
  std::map<Offset, double> near{{Offset{}, 1.}};
  Lengths piece = cell;
  DemagnetizingTensor sum;
  auto const at = [&](Offset const& offset) {
    Lengths place = position;
    for (std::size_t axis = 0; axis < 3; ++axis)
      place[axis] += static_cast<double>(offset[axis]) * piece[axis];
    return place;
  };
  for (;;) {
    auto const longest = std::max_element(piece.begin(), piece.end());
    if (*longest <= 16 * std::min({piece[0], piece[1], piece[2]})) break;
    auto const axis = static_cast<std::size_t>(longest - piece.begin());
    piece[axis] /= 2;
    double const reach = 4 * std::max({piece[0], piece[1], piece[2]});
    std::map<Offset, double> nearer;
    for (auto const& [offset, weight] : near)
      for (int const shift : {-1, 0, 1}) {
        auto halved = offset;
        halved[axis] = 2 * offset[axis] + shift;
        nearer[halved] += shift == 0 ? weight : weight / 2;
      }
    near.clear();
    for (auto const& [offset, weight] : nearer)
      if (norm(at(offset)) < reach)
        near.emplace(offset, weight);
      else
        add(sum, weight, cheapest_demagnetizing_tensor(at(offset), piece));
  }
  for (auto const& [offset, weight] : near)
    add(sum, weight, cheapest_demagnetizing_tensor(at(offset), piece));
  return sum;
}

}  // namespace detail

/// Returns N between two rectangular cells whose centres differ by `position` and whose edges along
/// x, y and z are `cell` (positive, in the unit of `position`). N has no unit. Its trace is 1 at
/// position 0, and 0 where the cells do not overlap. Its symmetries are exact: xy is odd in x and
/// in y, and so on.
///
/// At distances below 4 times the longest edge, N comes from second differences of the functions of
/// Newell, Williams and Dunlop, J. Geophys. Res. 98, 9551 (1993), eqs. 27 and 32. Farther away it
/// comes from the Taylor series of these differences in edge / distance, of order 22, 12 (from 8
/// edges) and 6 (from 50 edges). Where the differences would lose too many digits, long or flat
/// cells are divided into pieces.
///
/// For ratios of edges up to 1e6, the error is at most 3e-11 times the largest entry of N at this
/// position, and at most 1e-12 times this entry from a distance of 4 times the longest edge on. For
/// ratios from 1e6 to 1e9, the error is at most 1e-8 times that entry, and also at most 1e-15 in
/// absolute value. This needs a long double with a mantissa of 64 bits or more.
inline DemagnetizingTensor demagnetizing_tensor(std::array<double, 3> const& position,
                                                std::array<double, 3> const& cell) {
  auto const [x, y, z] = position;
  auto n = detail::cheapest_demagnetizing_tensor({std::abs(x), std::abs(y), std::abs(z)}, cell);
  auto const sign = [](double a) { return a > 0 ? 1. : a < 0 ? -1. : 0.; };
  n.xy *= sign(x) * sign(y);
  n.xz *= sign(x) * sign(z);
  n.yz *= sign(y) * sign(z);
  return n;
}

}  // namespace cayspin::inline v0_2
