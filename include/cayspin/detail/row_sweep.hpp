// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/sweep_plan.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace cayspin::inline v0_2::detail {

/// One part of a sweep through a lattice of one plane, at one of its ticks. In a tick each stage
/// works on plan.block further rows, one row behind the stage before it.
template <class Real>
struct RowSweepPart {
  SweepPlan const& plan;
  SweepRange<Axis> y;
  SweepRange<PlaneAxis> z;
  Real* memory;
  std::int32_t ticks, tick = 0;

  RowSweepPart(SweepPlan const& whole, Real* buffers, std::int64_t part)
      : plan(whole),
        y(whole.range_y(part)),
        z(whole.range_z(part)),
        memory(buffers + part * whole.part_size()),
        ticks((y.end + whole.stages - 1 - y.low(0) + whole.block - 1) / whole.block) {}

  std::int32_t low(int stage) const { return clamped(front(stage), stage); }
  std::int32_t high(int stage) const { return clamped(front(stage) + plan.block, stage); }

  /// Returns the rows of a buffer that are in use. Rows from `first` on are at the start of the
  /// ring.
  CAYSPIN_DETAIL_NOINLINE PlaneRows<Real> rows(int number, std::int32_t) const {
    SweepBuffer const& buffer = plan.buffer[number];
    Real* const ring = memory + buffer.ring;
    std::int32_t const newest = front(buffer.producer) + plan.block - 1;
    std::int32_t const origin = y.low(0) - plan.stages * buffer.planes;
    std::int32_t const first = newest - (newest - origin) % buffer.planes;
    return {ring + buffer.planes * plan.row,          ring,     nullptr,   first,
            std::numeric_limits<std::int32_t>::max(), plan.row, plan.pitch};
  }

 private:
  std::int32_t front(int stage) const { return y.low(0) + tick * plan.block - stage; }
  std::int32_t clamped(std::int32_t row, int stage) const {
    return std::clamp(row, y.low(stage), y.high(stage));
  }
};

}  // namespace cayspin::inline v0_2::detail
