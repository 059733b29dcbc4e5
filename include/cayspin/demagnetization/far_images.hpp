// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/demagnetization/tensor.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// The sum of the tensors between a cell and infinitely many images of another, along one or two
/// periodic axes, without the nearest images. Beyond 16 periods (or the nearest images, if there
/// are more), lines of dipoles replace the images along the axis of the shorter period. Likewise,
/// sheets replace the lines beyond 16 periods along the other axis. The fields of lines and sheets
/// are integrals in closed form. Corrections by differences over a period, of orders up to six,
/// turn the integrals into sums over images, averaged over the cells' edges along the axis of that
/// period; quadrature averages over the other edges. The error is below 1e-10, where 1 is the trace
/// of a cell's own tensor.
class FarImages {
 public:
  /// `period`: 0 along non-periodic axes. `nearest`: images on each side to leave out.
  FarImages(Lengths const& cell, Lengths const& period, std::array<int, 3> const& nearest)
      : cell_(cell), period_(period), nearest_(nearest) {
    std::vector<std::size_t> periodic;
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (period[axis] > 0) periodic.push_back(axis);
    std::ranges::sort(periodic, {}, [&](std::size_t axis) { return period[axis]; });
    line_ = periodic.front();
    for (auto const axis : periodic) images_[axis] = std::max(16, nearest[axis]);
    for (std::size_t axis = 0; axis < 3; ++axis)
      of_lines_[axis] = axis == line_ ? over_periods(axis) : over_an_edge(axis, beyond(line_));
    if (periodic.size() < 2) return;
    sheet_ = periodic[1];
    of_sheets_[0] = over_periods(*sheet_);
    of_sheets_[1] = over_an_edge(normal(), beyond(*sheet_));
  }

  DemagnetizingTensor operator()(Lengths const& position) const {
    DemagnetizingTensor sum;
    auto const [x, y, z] = images_;
    for (int i = -x; i <= x; ++i)
      for (int j = -y; j <= y; ++j)
        for (int k = -z; k <= z; ++k) {
          std::array const image{i, j, k};
          Lengths at = position;
          bool is_near = true;
          for (std::size_t axis = 0; axis < 3; ++axis) {
            at[axis] += image[axis] * period_[axis];
            is_near = is_near && std::abs(image[axis]) <= nearest_[axis];
          }
          if (!is_near) add(sum, 1., cheapest_demagnetizing_tensor(at, cell_));
          if (image[line_] == 0) add(sum, 1., along_line(at));
        }
    if (sheet_) add(sum, 1., in_sheet(position));
    return sum;
  }

 private:
  struct WeightedShift {
    double shift, weight;
  };
  using WeightedShifts = std::vector<WeightedShift>;
  using Entries = std::array<std::array<double, 3>, 3>;

  double beyond(std::size_t axis) const { return (images_[axis] + 0.5) * period_[axis]; }
  std::size_t normal() const { return 3 - line_ - *sheet_; }

  /// Returns the shifts and weights of an operator along a periodic axis: asinh(d/2) / (d/2), which
  /// turns an integral into a sum over images, times the mean over both cells' edges. d is the
  /// central difference over a period.
  WeightedShifts over_periods(std::size_t axis) const {
    double const edge = cell_[axis] / period_[axis], q = edge * edge;
    double const of_sum[] = {-1. / 24, 3. / 640, -5. / 7168};
    double const of_cells[] = {q / 12, q * q / 360 - q / 144,
                               q / 1080 - q * q / 2160 + q * q * q / 20160};
    double const second = of_sum[0] + of_cells[0];
    double const fourth = of_sum[1] + of_sum[0] * of_cells[0] + of_cells[1];
    double const sixth =
        of_sum[2] + of_sum[1] * of_cells[0] + of_sum[0] * of_cells[1] + of_cells[2];
    double const weights[] = {1 - 2 * second + 6 * fourth - 20 * sixth,
                              second - 4 * fourth + 15 * sixth, fourth - 6 * sixth, sixth};
    WeightedShifts shifts{{0, weights[0]}};
    for (int n = 1; n <= 3; ++n)
      for (int const side : {-1, 1}) shifts.push_back({side * n * period_[axis], weights[n]});
    return shifts;
  }

  /// Returns the shifts and weights of the mean over both cells' edges along an axis. The edges are
  /// divided into pieces of at most `distance` / 24; `distance` is that at which the lines or
  /// sheets begin. For each pair of pieces, a rule of three points is exact for polynomials up to
  /// degree 5.
  WeightedShifts over_an_edge(std::size_t axis, double distance) const {
    auto const pieces = static_cast<int>(std::ceil(24 * cell_[axis] / distance));
    double const piece = cell_[axis] / pieces, point = std::sqrt(0.4) * piece;
    constexpr double outer = 5. / 24;
    WeightedShifts shifts;
    for (int i = 1 - pieces; i < pieces; ++i) {
      double const pairs = (pieces - std::abs(i)) / (1. * pieces * pieces);
      shifts.push_back({i * piece - point, pairs * outer});
      shifts.push_back({i * piece, pairs * (1 - 2 * outer)});
      shifts.push_back({i * piece + point, pairs * outer});
    }
    return shifts;
  }

  DemagnetizingTensor along_line(Lengths const& position) const {
    Entries sum{};
    for (auto const& x : of_lines_[0])
      for (auto const& y : of_lines_[1])
        for (auto const& z : of_lines_[2])
          add_line(sum, x.weight * y.weight * z.weight,
                   {position[0] + x.shift, position[1] + y.shift, position[2] + z.shift});
    return of_dipoles(sum, period_[line_]);
  }

  DemagnetizingTensor in_sheet(Lengths const& position) const {
    Entries sum{};
    for (auto const& across : of_sheets_[0])
      for (auto const& up : of_sheets_[1])
        add_sheet(sum, across.weight * up.weight, position[*sheet_] + across.shift,
                  position[normal()] + up.shift);
    return of_dipoles(sum, period_[line_] * period_[*sheet_]);
  }

  DemagnetizingTensor of_dipoles(Entries const& e, double per) const {
    double const scale = cell_[0] * cell_[1] * cell_[2] / (4 * std::numbers::pi * per);
    return {scale * e[0][0], scale * e[1][1], scale * e[2][2],
            scale * e[0][1], scale * e[0][2], scale * e[1][2]};
  }

  static void fill(Entries& e, std::size_t i, std::size_t j, double value) {
    e[i][j] += value;
    if (i != j) e[j][i] += value;
  }

  /// Adds the tensor of the two half-lines that replace the images farther away than those that are
  /// summed one by one: `weight` times the derivatives -d_i d_j of the integral of 1/r.
  void add_line(Entries& e, double weight, Lengths const& at) const {
    std::size_t const p = line_, q = (p + 1) % 3, n = (p + 2) % 3;
    double const y = at[q], z = at[n];
    for (int const side : {-1, 1}) {
      double const u = beyond(p) + side * at[p];
      double const r = std::sqrt(u * u + y * y + z * z), r3 = r * r * r;
      double const first = weight / (r * (r + u));
      double const second = weight * (2 * r + u) / (r3 * (r + u) * (r + u));
      fill(e, p, p, -weight * u / r3);
      fill(e, q, q, first - y * y * second);
      fill(e, n, n, first - z * z * second);
      fill(e, p, q, -side * weight * y / r3);
      fill(e, p, n, -side * weight * z / r3);
      fill(e, q, n, -y * z * second);
    }
  }

  /// Adds the tensor of the two half-sheets that replace the lines farther away than those that are
  /// summed one by one.
  void add_sheet(Entries& e, double weight, double y, double z) const {
    std::size_t const q = *sheet_, n = normal();
    for (int const side : {-1, 1}) {
      double const u = beyond(q) + side * y, of_edge = 2 * weight / (u * u + z * z);
      fill(e, q, q, -u * of_edge);
      fill(e, n, n, u * of_edge);
      fill(e, q, n, -side * z * of_edge);
    }
  }

  Lengths cell_, period_;
  std::array<int, 3> nearest_, images_{};
  std::size_t line_ = 0;              // axis of the shorter period
  std::optional<std::size_t> sheet_;  // the other periodic axis
  std::array<WeightedShifts, 3> of_lines_;
  std::array<WeightedShifts, 2> of_sheets_;
};

}  // namespace cayspin::inline v0_2::detail
