// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/rows.hpp>
#include <cayspin/stage/data_flow.hpp>

#include <cstdint>

// A Runge-Kutta stage on host spaces: the rows of a plane, a pack of spins at a time.
namespace cayspin::detail {

/// The planes that a stage reads and writes, wherever their rows lie.
template <class Kernel>
struct StagePlanes {
  using Real = typename Kernel::value_type;
  static constexpr int stages = Kernel::stages;

  Axis y;
  PlaneRows<Real> start, level[3], increments[stages > 1 ? stages - 1 : 1];
  PlaneRows<Real> sum_before, sum, increment, next, residual;
  bool from_memory = false, level_from_memory = false;  // not from a cache
  bool sum_streams = false, increment_streams = false, next_streams = false;

  KOKKOS_FORCEINLINE_FUNCTION StageRows<Real, stages> rows(std::int32_t at) const {
    StageRows<Real, stages> rows;
    // What comes from memory is asked for one row ahead; of the planes of neighbours, that is the
    // one behind.
    std::ptrdiff_t const ahead = from_memory ? start.pitch : 0;
    if constexpr (Kernel::reads_start) rows.start = start.input(at, ahead);
    rows.level.data = level[1].row(at);
    rows.level.stride = level[1].stride;
    rows.level.neighbor[0][0] = level[1].row(y.previous(at));
    rows.level.neighbor[0][1] = level[1].row(y.next(at));
    rows.level.neighbor[1][0] = level[0].row(at);
    rows.level.neighbor[1][1] = level[2].row(at);
    rows.level.ahead =
        level_from_memory ? rows.level.neighbor[1][1] - rows.level.data + level[2].pitch : 0;
    unrolled<stages - 1>([&](auto i) {
      if constexpr (Kernel::reads_increment(i()))
        rows.increments[i()] = increments[i()].input(at, ahead);
    });
    if constexpr (Kernel::reads_sum) rows.sum_before = sum_before.input(at, ahead);
    if constexpr (Kernel::writes_sum) rows.sum = sum.output(at, sum_streams);
    if constexpr (Kernel::stores_increment)
      rows.increment = increment.output(at, increment_streams);
    rows.next = next.output(at, next_streams);
    if constexpr (Kernel::compensates) {
      rows.residual_before = residual.input(at, ahead);
      rows.residual = residual.output(at, false);
    }
    return rows;
  }
};

/// A stage on given rows.
template <class Kernel>
struct StageOnRows {
  Kernel const& kernel;
  typename Kernel::Rows const& rows;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    kernel(site, rows);
  }
};

/// The one compiled body of a stage on host spaces: the bits do not depend on who calls it.
template <class Kernel>
CAYSPIN_DETAIL_NOINLINE void run_stage(Kernel const& kernel, StagePlanes<Kernel> const& planes,
                                       RowLayout const& layout, RowBlock const& block) {
  Kernel const local = kernel;
  for (std::int32_t y = block.y_begin; y < block.y_end; ++y) {
    typename Kernel::Rows const rows = planes.rows(y);
    Row const row(layout, planes.y.wrapped(y), block.z);
    for_each_pack<Pack<typename Kernel::value_type>>(row, block.pack_begin, block.pack_end,
                                                     StageOnRows<Kernel>{local, rows});
  }
}

}  // namespace cayspin::detail
