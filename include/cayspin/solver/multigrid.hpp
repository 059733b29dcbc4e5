// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/solver/multigrid_kernels.hpp>
#include <cayspin/solver/multigrid_level.hpp>
#include <cayspin/solver/multigrid_transfers.hpp>
#include <cayspin/spin_field.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// One multigrid cycle on cell-centred grids for an Operation (ShiftedExchange or ShiftedSpinWaves)
/// in precision Real. It relaxes after the coarse-grid correction and, if IsSymmetric, equally
/// often before it, which makes the cycle a symmetric map. On hosts, the small grids share one
/// kernel on the calling thread. Results are bitwise identical for any number of threads and in any
/// host space.
template <class Operation, int Relaxations, bool IsSymmetric, class Real, class MemorySpace>
class Multigrid {
  static constexpr int right_components = Operation::right_components;
  using Coefficient = typename Operation::Coefficient;
  using Field = SiteField<Real, 3, MemorySpace>;
  using Right = SiteField<Real, right_components, MemorySpace>;
  using Level = MultigridLevel<Real, right_components, MemorySpace>;

 public:
  Multigrid() = default;
  /// `couplings`: J of each axis, at least 0.
  Multigrid(std::string const& name, Lattice lattice, std::array<double, 3> const& couplings)
      : relax_label_("cayspin::" + name + "::relax"),
        residual_label_("cayspin::" + name + "::residual"),
        restrict_label_("cayspin::" + name + "::restrict"),
        interpolate_label_("cayspin::" + name + "::interpolate"),
        coarse_label_("cayspin::" + name + "::coarse") {
    lattice.cell_sites = 1;  // coarse grids need not hold whole cells of a crystal
    std::vector<CellAxis> axes;
    for (std::size_t axis = 0; axis < 3; ++axis)
      axes.emplace_back(lattice.shape[axis], lattice.boundary[axis] == Boundary::periodic);
    do
      levels_.emplace_back(name + "::level_" + std::to_string(levels_.size()), lattice, couplings,
                           axes, !IsSymmetric);
    while (!levels_.back().coarsened.empty());
  }

  /// Returns the right-hand side, which the caller fills. The padding of its rows is zero, and must
  /// stay so.
  Right const& right() const { return levels_.front().right; }

  /// Writes the solution to `out`. `same_directions`: coarse grids keep the directions (of
  /// ShiftedSpinWaves) from the previous call. Does not wait.
  template <class Exec, class OutReal>
  void solve(Exec const& exec, Coefficient b, CellArray<OutReal, 3> const& out,
             bool same_directions = false) const {
    solve_from(exec, LaunchEach<Exec>{exec}, {b, same_directions}, out, 0);
  }

 private:
  struct Shift {
    Coefficient b;
    bool same_directions;
  };

  template <class OutReal>
  struct CoarseCycle {
    Multigrid const* multigrid;
    Shift shift;
    CellArray<OutReal, 3> out;
    std::size_t number;

    void operator()(std::int64_t) const {
      multigrid->cycle(Inside{}, RunInside{}, shift, out, number);
    }
  };
  struct Inside {};

  /// Runs the cycle on this level and the coarser ones.
  template <class Exec, class Launch, class OutReal>
  void solve_from(Exec const& exec, Launch const& launch, Shift const& shift,
                  CellArray<OutReal, 3> const& out, std::size_t number) const {
    if constexpr (is_synchronous<Exec>) {
      auto const sites = sites_worth(levels_[number].layout);
      if (runs_on_calling_thread<Exec>(sites))
        return for_each_task(exec, coarse_label_, 1, sites,
                             CoarseCycle<OutReal>{this, shift, out, number});
    }
    cycle(exec, launch, shift, out, number);
  }

  // Return the field that a level's last relaxation reads, and the field for its solution if the
  // level is not the finest.
  static Field const& last_of(Level const& level) {
    return Relaxations % 2 == 0 ? level.other : level.one;
  }
  static Field const& result_of(Level const& level) {
    return Relaxations % 2 == 0 ? level.one : level.other;
  }

  // Returns the relaxation that is exact at a frequency: zero `k` of Chebyshev's polynomial of
  // degree `count` on [least, largest].
  static Operation relaxation(Coefficient b, double least, double largest, int count, int k) {
    double const angle = std::numbers::pi * (2 * k + 1) / (2 * count);
    return Operation::relaxing(b,
                               0.5 * (largest + least) + 0.5 * (largest - least) * std::cos(angle));
  }

  template <class Exec, class Launch, class OutReal>
  void cycle(Exec const& exec, Launch const& launch, Shift const& shift,
             CellArray<OutReal, 3> const& out, std::size_t number) const {
    Level const& level = levels_[number];
    Coefficient const b = shift.b;
    if (level.coarsened.empty()) return relax_zero(launch, level, Operation::relaxing(b, 0), out);
    if (level.largest * std::abs(b) <= 1) {
      auto const at = [&](int k) { return relaxation(b, 0, level.largest, 3, k); };
      relax_zero(launch, level, at(0), cells_of<3>(result_of(level)));
      relax<false>(launch, level, at(1), result_of(level), cells_of<3>(last_of(level)));
      return relax<false>(launch, level, at(2), last_of(level), out);
    }
    auto const at = [&](int k) {
      return relaxation(b, level.least, level.largest, Relaxations, k);
    };
    Level const& next = levels_[number + 1];
    if constexpr (IsSymmetric) {
      Field const *u = &level.one, *free = &level.other;
      if (Relaxations % 2 == 0) std::swap(u, free);
      relax_zero(launch, level, at(0), cells_of<3>(*u));
      for (int k = 1; k < Relaxations; ++k) {
        relax<false>(launch, level, at(k), *u, cells_of<3>(*free));
        std::swap(u, free);
      }
      relax<true>(launch, level, at(0), *u, cells_of<3>(*free));
      restrict_to<right_components>(launch, level, *free, next.right);
    } else if (shift.same_directions) {
      restrict_to<3>(launch, level, level.right, next.right);
    } else {
      restrict_to<right_components>(launch, level, level.right, next.right);
    }
    solve_from(exec, launch, shift, cells_of<3>(result_of(next)), number + 1);
    interpolate_from(launch, level, result_of(next));
    if constexpr (right_components == 6)
      launch.template run<Real>(
          interpolate_label_, level.layout,
          KeepAcross<Real>{level.grid.extent[0], cells_of<6>(level.right), cells_of<3>(level.one)});
    Field const *u = &level.one, *free = &level.other;
    for (int k = Relaxations - 1; k > 0; --k) {
      relax<false>(launch, level, at(k), *u, cells_of<3>(*free));
      std::swap(u, free);
    }
    relax<false>(launch, level, at(0), *u, out);
  }

  template <class Launch, class OutReal>
  void relax_zero(Launch const& launch, Level const& level, Operation const& operation,
                  CellArray<OutReal, 3> const& out) const {
    launch.template run<Real>(
        relax_label_, level.layout,
        RelaxZero<Operation, Real, OutReal>{level.grid.extent[0], operation,
                                            cells_of<right_components>(level.right), out});
  }
  template <bool Residual, class Launch, class OutReal>
  void relax(Launch const& launch, Level const& level, Operation const& operation, Field const& u,
             CellArray<OutReal, 3> const& out) const {
    launch.template run<Real>(
        Residual ? residual_label_ : relax_label_, level.layout,
        RelaxCells<Operation, Residual, Real, OutReal>{level.grid, operation, cells_of<3>(u),
                                                       cells_of<right_components>(level.right), out,
                                                       level.grid.periodic[0]});
  }

  template <int Components, class Launch>
  void restrict_to(Launch const& launch, Level const& level, Right const& fine,
                   Right const& coarse) const {
    Right const* from = &fine;
    for (std::size_t i = 0; i < level.coarsened.size(); ++i) {
      auto const& to = i < level.between.size() ? level.rights_between[i] : coarse;
      int const axis = level.coarsened[i];
      auto const& numbers = level.grid.axis[axis];
      auto const source = cells_of<Components>(*from), target = cells_of<Components>(to);
      if (axis == 0)
        launch.template run<Real>(
            restrict_label_, to.layout(),
            RestrictAlongRows<Real, Components>{level.grid.extent[0], numbers.coarse_cells, numbers,
                                                source, target});
      else
        launch.template run<Real>(
            restrict_label_, to.layout(),
            RestrictRows<Real, Components>{axis, level.grid.extent[axis], numbers, source, target});
      from = &to;
    }
  }

  template <class Launch>
  void interpolate_from(Launch const& launch, Level const& level, Field const& coarse) const {
    Field const* from = &coarse;
    for (std::size_t i = level.coarsened.size(); i-- > 0;) {
      Field const& to = i > 0 ? level.between[i - 1] : level.one;
      if (IsSymmetric && i == 0)
        interpolate<true>(launch, level, level.coarsened[i], *from, to);
      else
        interpolate<false>(launch, level, level.coarsened[i], *from, to);
      from = &to;
    }
  }
  template <bool Adds, class Launch>
  void interpolate(Launch const& launch, Level const& level, int axis, Field const& from,
                   Field const& to) const {
    auto const& numbers = level.grid.axis[axis];
    auto const source = cells_of<3>(from), target = cells_of<3>(to);
    if (axis == 0)
      launch.template run<Real>(
          interpolate_label_, to.layout(),
          InterpolateAlongRows<Real, Adds>{level.grid.extent[0], numbers.coarse_cells, numbers,
                                           source, target});
    else
      launch.template run<Real>(interpolate_label_, to.layout(),
                                InterpolateRows<Real, Adds>{axis, numbers.coarse_cells, numbers,
                                                            to.layout().nx, source, target});
  }

  std::string relax_label_, residual_label_, restrict_label_, interpolate_label_, coarse_label_;
  std::vector<Level> levels_;
};

}  // namespace cayspin::inline v0_2::detail
