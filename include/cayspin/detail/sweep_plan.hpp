// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/rows.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

// How a sweep divides a lattice: into one part per thread, along z and y, and each part into blocks
// of rows whose buffers fit the cache. Seams hold the rows that two blocks share.
namespace cayspin::detail {

/// The planes or rows of one part. At an end inside the lattice, at ghosts or at a periodic end,
/// each earlier stage goes one plane or row further. The next part computes these sites, too.
struct SweepRange {
  std::int32_t begin, end, stages;
  Axis axis;

  std::int32_t low(int stage) const { return begin - (ends_inside(begin) ? ahead(stage) : 0); }
  std::int32_t high(int stage) const { return end + (ends_inside(end) ? ahead(stage) : 0); }

 private:
  bool ends_inside(std::int32_t i) const { return axis.wraps || (0 < i && i < axis.extent); }
  std::int32_t ahead(int stage) const { return stages - 1 - stage; }
};

/// One buffer: a ring of `planes` planes of rows, and a seam of planes - 1 rows for each plane of
/// the part.
struct SweepBuffer {
  std::int32_t producer = 0, planes = 0;
  std::ptrdiff_t ring = 0, seam = 0;  // offsets
};

struct SweepPlan {
  static constexpr int most_stages = 8;

  RowLayout layout;
  std::int32_t stages = 1, buffers = 0;
  std::int32_t parts_y = 1, parts_z = 1;
  std::int32_t block = 1;  // rows, at least; less than twice as many
  std::int32_t ring_rows = 0, seam_planes = 0;
  std::ptrdiff_t pitch = 0, row = 0;  // component to component in a buffer's row, row to row
  std::ptrdiff_t part_size = 0;       // numbers of memory per part
  SweepBuffer buffer[3 * most_stages];

  std::int64_t parts() const { return std::int64_t(parts_y) * parts_z; }
  std::size_t size() const { return static_cast<std::size_t>(parts() * part_size); }

  SweepRange range_y(std::int64_t part) const {
    return range(static_cast<std::int32_t>(part % parts_y), parts_y, layout.own.y_begin,
                 layout.own.ny(), Axis(layout, 1));
  }
  SweepRange range_z(std::int64_t part) const {
    return range(static_cast<std::int32_t>(part / parts_y), parts_z, layout.own.z_begin,
                 layout.own.nz(), Axis(layout, 2));
  }

  /// A plan for so many threads, with blocks of rows whose buffers take up `cache` bytes.
  template <class Real, class Buffers>
  static SweepPlan of(RowLayout const& layout, int threads, std::size_t cache) {
    static_assert(Buffers::stages <= most_stages);
    SweepPlan plan;
    plan.layout = layout;
    plan.stages = Buffers::stages;
    plan.buffers = Buffers::count;
    constexpr std::ptrdiff_t line = cache_line_bytes / static_cast<std::ptrdiff_t>(sizeof(Real));
    std::ptrdiff_t const lines = (layout.nx + line - 1) / line;
    plan.pitch = (lines % 2 == 0 ? lines + 1 : lines) * line;
    plan.row = 3 * plan.pitch;
    plan.cut(threads);

    std::int32_t planes = plan.stages + 2;  // of the state that are in use
    for (int b = 0; b < plan.buffers; ++b) planes += Buffers::planes(b);
    std::size_t const bytes = static_cast<std::size_t>(planes * plan.row) * sizeof(Real);
    std::int32_t const least = 2 * plan.stages;
    auto const all_rows = static_cast<std::size_t>(layout.ny);
    plan.block = std::max(least, static_cast<std::int32_t>(std::min(cache / bytes, all_rows)));
    std::int32_t const longest = (layout.ny + plan.parts_y - 1) / plan.parts_y;
    plan.ring_rows = std::min(2 * plan.block, longest) + 2 * plan.stages;
    plan.seam_planes = (layout.nz + plan.parts_z - 1) / plan.parts_z + 2 * plan.stages;

    std::ptrdiff_t size = line;  // a pack may read before the first row
    for (int b = 0; b < plan.buffers; ++b) {
      SweepBuffer& buffer = plan.buffer[b];
      buffer.producer = Buffers::producer(b);
      buffer.planes = Buffers::planes(b);
      if (buffer.planes == 0) continue;
      buffer.ring = size;
      size += buffer.planes * plan.ring_rows * plan.row;
      buffer.seam = size;
      if (plan.blocks(longest) > 1)
        size += (buffer.planes - 1) * (plan.seam_planes + buffer.planes) * plan.row;
    }
    plan.part_size = size + line;
    return plan;
  }

  std::int32_t blocks(std::int32_t rows) const { return std::max(1, rows / block); }

 private:
  SweepRange range(std::int32_t part, std::int32_t parts, std::int32_t begin, std::int32_t extent,
                   Axis const& axis) const {
    auto const bound = [&](std::int32_t i) {
      return begin + static_cast<std::int32_t>(std::int64_t(extent) * i / parts);
    };
    return {bound(part), bound(part + 1), stages, axis};
  }

  // The division into at most `threads` parts that repeats least work. It prefers z, along which
  // parts are far from each other in memory.
  void cut(int threads) {
    double least = -1;
    for (std::int32_t z = threads; z >= 1; --z) {
      if (threads % z != 0) continue;
      std::int32_t const y = threads / z;
      std::int32_t const nz = std::min(z, std::max(1, layout.own.nz() / (2 * stages)));
      std::int32_t const ny = std::min(y, std::max(1, layout.own.ny() / (2 * stages)));
      double const repeated = double(stages - 1) * (nz - 1) / layout.own.nz() +
                              double(stages - 1) * (ny - 1) / layout.own.ny();
      double const time = (1 + repeated) / (double(ny) * nz);
      if (least < 0 || time < least) least = time, parts_y = ny, parts_z = nz;
    }
  }
};

/// Fills the buffers: the few numbers that belong to no site must not trap or be denormal. One task
/// per part, so that the thread of a part is the first to touch its memory.
template <class Real>
struct FillSweepBuffers {
  Real* data;
  SweepPlan plan;

  void operator()(std::int64_t part) const {
    std::fill_n(data + part * plan.part_size, plan.part_size, Real(0));
  }
};

/// One part of a sweep, at one of its blocks.
template <class Real>
struct SweepPart {
  SweepPlan const& plan;
  SweepRange y, z;
  Real* memory;
  std::int32_t blocks, block = 0;

  SweepPart(SweepPlan const& whole, Real* buffers, std::int64_t part)
      : plan(whole),
        y(whole.range_y(part)),
        z(whole.range_z(part)),
        memory(buffers + part * whole.part_size),
        blocks(whole.blocks(y.end - y.begin)) {}

  /// A stage works on rows low .. high - 1, one row later than the stage before it.
  std::int32_t low(int stage) const { return block == 0 ? y.low(stage) : bound(block) - stage; }
  std::int32_t high(int stage) const {
    return block + 1 == blocks ? y.high(stage) : bound(block + 1) - stage;
  }

  /// Plane z of a buffer.
  CAYSPIN_DETAIL_NOINLINE PlaneRows<Real> rows(int number, std::int32_t at_z) const {
    SweepBuffer const& buffer = plan.buffer[number];
    std::int32_t const seam_rows = buffer.planes - 1, from_begin = at_z - z.low(0);
    std::int32_t const first = low(buffer.producer);
    std::int32_t const last = high(buffer.producer) - (block + 1 == blocks ? 0 : seam_rows);
    Real* const ring =
        memory + buffer.ring + from_begin % buffer.planes * plan.ring_rows * plan.row;
    // A seam's planes move on by `planes` from block to block. So planes of the block before are
    // not overwritten while they are still needed.
    auto const seam = [&](std::int32_t of_block) {
      std::int32_t const slots = plan.seam_planes + buffer.planes;
      std::int32_t slot = (from_begin - of_block * buffer.planes) % slots;
      if (slot < 0) slot += slots;
      return memory + buffer.seam + slot * seam_rows * plan.row;
    };
    return {seam(block - 1) + seam_rows * plan.row,
            ring,
            seam(block),
            first,
            last,
            plan.row,
            plan.pitch};
  }

 private:
  std::int32_t bound(std::int32_t i) const {
    return y.begin + static_cast<std::int32_t>(std::int64_t(y.end - y.begin) * i / blocks);
  }
};

}  // namespace cayspin::detail
