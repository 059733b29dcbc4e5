// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/ghosts.hpp>
#include <cayspin/solver/line_solver.hpp>
#include <cayspin/solver/multigrid_kernels.hpp>
#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::detail {

/// Approximates z = (c + b K)^-1 r for each component of fields of vectors, with K = -J Lap >= 0
/// over the neighbours of a lattice. Scalar, of b, is float, double or a Kokkos::complex of either;
/// a complex vector has six components, the real parts first.
/// Where one axis alone couples, z is the solution. Otherwise it is one multigrid cycle V(2, 2) on
/// cell-centred grids, which leaves a fifth to a half of the residual where b K is not negative. A
/// cycle is a linear map, symmetric and positive definite for real b >= 0 and c > 0. Its bits do
/// not depend on threads or host spaces.
template <class Scalar, class MemorySpace>
class Helmholtz {
 public:
  using Real = real_part_t<Scalar>;
  static constexpr int components = 3 * real_parts<Scalar>;
  using Field = SiteField<Real, components, MemorySpace>;

  Helmholtz() = default;
  /// `couplings`: J of each axis, A / spacing^2 for exchange; those that are not positive, and
  /// those of axes without neighbours, are left out. Throws std::invalid_argument for a part of a
  /// lattice.
  Helmholtz(std::string const& name, Lattice const& lattice, std::array<double, 3> couplings)
      : scale_label_("cayspin::" + name + "::scale"),
        relax_label_("cayspin::" + name + "::relax"),
        residual_label_("cayspin::" + name + "::residual"),
        restrict_label_("cayspin::" + name + "::restrict"),
        interpolate_label_("cayspin::" + name + "::interpolate") {
    require_whole("cayspin::Helmholtz", lattice);
    std::vector<int> coupled;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (!lattice.has_neighbors(static_cast<int>(axis)) || !(couplings[axis] > 0))
        couplings[axis] = 0;
      if (couplings[axis] > 0) coupled.push_back(static_cast<int>(axis));
    }
    if (coupled.size() == 1)
      lines_.emplace(name, RowLayout::of<Real>(lattice), coupled.front(),
                     couplings[static_cast<std::size_t>(coupled.front())]);
    else
      make_levels(name, lattice, couplings);
  }

  /// `r` has three components, or six where b is complex; it is not `z`. Does not wait.
  template <class Exec, int RightHandComponents>
  void solve(Exec const& exec, double c, Scalar b,
             SiteField<Real, RightHandComponents, MemorySpace> const& r, Field const& z) {
    if (lines_) return lines_->solve(exec, c, b, r, z);
    cycle(exec, c, b, r, z, 0);
  }

 private:
  struct Level {
    RowLayout layout;
    std::array<CellAxisTables<Real, MemorySpace>, 3> tables;
    double least = 0, largest = 0;  // frequencies of K, of those that smoothing is for
    std::vector<std::size_t> coarsened;
    Field right, solution, other;  // the finest level has those that it is given
    std::vector<Field> between;    // the next level, where not all axes are coarsened yet

    CellGrid<Real> grid() const {
      return {layout, {tables[0].arrays(), tables[1].arrays(), tables[2].arrays()}};
    }
  };

  void make_levels(std::string const& name, Lattice lattice,
                   std::array<double, 3> const& couplings) {
    std::vector<CellAxis> axes;
    for (std::size_t axis = 0; axis < 3; ++axis)
      axes.emplace_back(lattice.shape[axis], lattice.boundary[axis] == Boundary::periodic);
    do {
      std::string const label = name + "::level_" + std::to_string(levels_.size());
      Level level;
      level.layout = RowLayout::of<Real>(lattice);
      level.other = Field(label + "::other", lattice);
      if (!levels_.empty()) {
        level.right = Field(label + "::right", lattice);
        level.solution = Field(label + "::solution", lattice);
      }
      std::array<double, 3> strengths{};  // J over the cells' width squared
      for (std::size_t axis = 0; axis < 3; ++axis) {
        level.tables[axis] = {label, axes[axis], couplings[axis]};
        strengths[axis] = 0.5 * couplings[axis] * axes[axis].largest_sum();
        level.largest += 4 * strengths[axis];
      }
      double const strongest = *std::max_element(strengths.begin(), strengths.end());
      level.least = level.largest;
      for (std::size_t axis = 0; axis < 3; ++axis) {
        if (strengths[axis] == 0 || strengths[axis] < 0.5 * strongest) continue;
        if (!level.coarsened.empty()) level.between.emplace_back(label + "::between", lattice);
        level.coarsened.push_back(axis);
        level.least = std::min(level.least, 1.5 * strengths[axis]);
        axes[axis] = axes[axis].coarser();
        lattice.shape[axis] = static_cast<std::int64_t>(axes[axis].cells());
      }
      levels_.push_back(std::move(level));
    } while (!levels_.back().coarsened.empty());
  }

  // 1 / (c + b s) for s at the zeros of Chebyshev's polynomial on [least, largest].
  template <std::size_t Count>
  static std::array<Scalar, Count> weights(double c, Scalar b, double least, double largest) {
    std::array<Scalar, Count> weights;
    for (std::size_t k = 0; k < Count; ++k) {
      double const angle =
          std::numbers::pi * (2 * static_cast<double>(k) + 1) / (2 * static_cast<double>(Count));
      double const s = 0.5 * (largest + least) + 0.5 * (largest - least) * std::cos(angle);
      weights[k] = Scalar(1) / (Scalar(static_cast<Real>(c)) + b * static_cast<Real>(s));
    }
    return weights;
  }

  template <class Exec, int RightHandComponents>
  void cycle(Exec const& exec, double c, Scalar b,
             SiteField<Real, RightHandComponents, MemorySpace> const& right, Field const& solution,
             std::size_t number) {
    Level const& level = levels_[number];
    Field const& other = level.other;
    if (level.coarsened.empty())
      return scale(exec, level, Scalar(static_cast<Real>(1 / c)), right, solution);
    if (level.largest * magnitude(b) <= c) {
      auto const weight = weights<3>(c, b, 0, level.largest);
      scale(exec, level, weight[0], right, solution);
      relax(exec, level, c, b, weight[1], solution, right, other);
      return relax(exec, level, c, b, weight[2], other, right, solution);
    }
    auto const weight = weights<2>(c, b, level.least, level.largest);
    scale(exec, level, weight[0], right, other);
    relax(exec, level, c, b, weight[1], other, right, solution);
    relax(exec, level, c, b, weight[1], solution, right, other, true);
    Level const& next = levels_[number + 1];
    restrict_to(exec, level, next.right);
    cycle(exec, c, b, next.right, next.solution, number + 1);
    interpolate_from(exec, level, next.solution, solution);
    relax(exec, level, c, b, weight[1], solution, right, other);
    relax(exec, level, c, b, weight[0], other, right, solution);
  }

  static double magnitude(Scalar b) {
    if constexpr (components == 3)
      return std::abs(static_cast<double>(b));
    else
      return std::hypot(static_cast<double>(b.real()), static_cast<double>(b.imag()));
  }

  template <class Exec, int RightHandComponents>
  void scale(Exec const& exec, Level const& level, Scalar weight,
             SiteField<Real, RightHandComponents, MemorySpace> const& right,
             Field const& out) const {
    for_each_cell(
        exec, scale_label_, level.layout,
        ScaleCells<Scalar, RightHandComponents>{level.layout, weight, right.array(), out.array()});
  }
  template <class Exec, int RightHandComponents>
  void relax(Exec const& exec, Level const& level, double c, Scalar b, Scalar weight,
             Field const& u, SiteField<Real, RightHandComponents, MemorySpace> const& right,
             Field const& out, bool residual = false) const {
    for_each_cell(exec, residual ? residual_label_ : relax_label_, level.layout,
                  RelaxCells<Scalar, RightHandComponents>{level.grid(), static_cast<Real>(c), b,
                                                          residual ? Scalar(1) : weight, u.array(),
                                                          right.array(), out.array(), residual});
  }
  template <class Exec>
  void restrict_to(Exec const& exec, Level const& level, Field const& coarse) const {
    Field const* from = &level.other;
    for (std::size_t i = 0; i < level.coarsened.size(); ++i) {
      Field const& to = i < level.between.size() ? level.between[i] : coarse;
      std::size_t const axis = level.coarsened[i];
      for_each_cell(exec, restrict_label_, to.layout(),
                    RestrictCells<Real, components>{
                        from->layout(), to.layout(), static_cast<int>(axis),
                        level.tables[axis].arrays().weights, from->array(), to.array()});
      from = &to;
    }
  }
  template <class Exec>
  void interpolate_from(Exec const& exec, Level const& level, Field const& coarse,
                        Field const& solution) const {
    Field const* from = &coarse;
    for (std::size_t i = level.coarsened.size(); i-- > 0;) {
      Field const& to = i > 0 ? level.between[i - 1] : solution;
      std::size_t const axis = level.coarsened[i];
      for_each_cell(exec, interpolate_label_, to.layout(),
                    InterpolateCells<Real, components>{
                        from->layout(), to.layout(), static_cast<int>(axis),
                        level.tables[axis].arrays(), from->array(), to.array(), i == 0});
      from = &to;
    }
  }

  std::string scale_label_, relax_label_, residual_label_, restrict_label_, interpolate_label_;
  std::optional<LineSolver<Scalar, MemorySpace>> lines_;
  std::vector<Level> levels_;
};

}  // namespace cayspin::detail
