// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/rows.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

// How a sweep divides a lattice among threads, and each part into blocks of rows whose buffers fit
// the cache. Seams hold the rows that two blocks share. In a lattice of one plane stages follow
// each other by rows instead (row_sweep.hpp).
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

/// One buffer: a ring of `planes` planes of rows, and a seam of `seam_rows` rows for each plane of
/// the part. By rows: a ring of `planes` rows.
struct SweepBuffer {
  std::int32_t producer = 0, planes = 0, seam_rows = 0;
  std::ptrdiff_t ring = 0, seam = 0;  // offsets in the memory of a strip, and of a part
};

/// The lattice is cut into parts that know nothing of each other, along z and y. A part may be
/// cut into strips along y, one for each of several threads. They go through the planes together
/// and read each other's rows at the seams.
struct SweepPlan {
  static constexpr int most_stages = 13;

  RowLayout layout;
  std::int32_t stages = 1, buffers = 0;
  std::int32_t parts_y = 1, parts_z = 1, strips = 1;
  std::int32_t lag = 1;  // planes between a stage and the one before it
  bool by_rows = false;
  std::int32_t block = 1;  // rows, at least; less than twice as many. By rows: so many at a time
  std::int32_t ring_rows = 0, seam_planes = 0;
  std::ptrdiff_t pitch = 0, row = 0;  // component to component in a buffer's row, row to row
  std::ptrdiff_t strip_size = 0, seam_size = 0;  // numbers of memory per strip, and per part
  SweepBuffer buffer[3 * most_stages];

  std::int64_t parts() const { return std::int64_t(parts_y) * parts_z; }
  std::int64_t tasks() const { return parts() * strips; }
  std::ptrdiff_t part_size() const { return strips * strip_size + seam_size; }
  /// Numbers of memory of the buffers.
  std::size_t size() const { return static_cast<std::size_t>(parts() * part_size()); }

  SweepRange range_y(std::int64_t part) const {
    return range(static_cast<std::int32_t>(part % parts_y), parts_y, layout.own.y_begin,
                 layout.own.ny(), Axis(layout, 1));
  }
  SweepRange range_z(std::int64_t part) const {
    return range(static_cast<std::int32_t>(part / parts_y), parts_z, layout.own.z_begin,
                 layout.own.nz(), Axis(layout, 2));
  }
  /// Blocks of each strip of a part with so many rows.
  std::int32_t blocks(std::int32_t rows) const { return std::max(1, rows / strips / block); }

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
    auto const planes_in_use = [&](std::int32_t lag) {
      std::int32_t planes = lag * plan.stages + 2;  // of the state
      for (int b = 0; b < plan.buffers; ++b) planes += Buffers::planes(b, lag);
      return planes;
    };
    auto const rows_in_cache =
        static_cast<std::int32_t>(cache / (static_cast<std::size_t>(plan.row) * sizeof(Real)));
    // Rows per block, if stages follow each other at so many planes.
    auto const block = [&](std::int32_t lag) {
      return std::max(2 * plan.stages, std::min(rows_in_cache / planes_in_use(lag), layout.ny));
    };
    plan.cut(threads, block(1), block(lag_of_strips));
    if (layout.nz == 1 && plan.strips == 1)
      plan.allot_rows<Buffers>(rows_in_cache - planes_in_use(1), line);
    else
      plan.allot<Buffers>(line);
    return plan;
  }

 private:
  /// A strip reads rows that its neighbours wrote a plane ago. So nobody waits within a plane.
  static constexpr std::int32_t lag_of_strips = 2;
  /// What it costs two strips to wait for each other once, in sites that could be stepped instead.
  static constexpr double meeting = 64;

  SweepRange range(std::int32_t part, std::int32_t parts, std::int32_t begin, std::int32_t extent,
                   Axis const& axis) const {
    auto const bound = [&](std::int32_t i) {
      return begin + static_cast<std::int32_t>(std::int64_t(extent) * i / parts);
    };
    return {bound(part), bound(part + 1), stages, axis};
  }

  // The division among at most `threads` threads that takes least time. Planes are cut first: the
  // parts are far from each other in memory. Repeated work counts twice: it is read twice, too.
  void cut(int threads, std::int32_t block_of_parts, std::int32_t block_of_strips) {
    std::int32_t const ny = layout.own.ny(), nz = layout.own.nz();
    auto const largest = [&](std::int32_t extent, std::int32_t parts) {
      double const repeated = std::min(parts - 1, 2) * (stages - 1);
      return (extent + parts - 1) / parts + repeated;
    };
    double least = -1;
    auto const consider = [&](std::int32_t z, std::int32_t y, std::int32_t of_strips) {
      bool const alone = of_strips == 1;
      std::int32_t const of_block = alone ? block_of_parts : block_of_strips;
      double const planes = largest(nz, z);
      double const rows = alone ? largest(ny, y) : (ny + of_strips - 1) / of_strips;
      double const rounds = std::max(1, ny / of_strips / of_block);
      double const waits = alone ? 0 : rounds * (planes + lag_of_strips * (stages - 1));
      double const time = planes * rows * layout.nx + meeting * waits;
      if (least >= 0 && time >= least) return;
      least = time;
      parts_z = z, parts_y = y, strips = of_strips, block = of_block;
      lag = alone ? 1 : lag_of_strips;
    };
    std::int32_t const most_z = std::max(1, nz / (2 * stages)),
                       most_y = std::max(1, ny / (2 * stages));
    for (std::int32_t z = std::min(threads, most_z); z >= 1; --z) {
      std::int32_t const rest = threads / z;
      consider(z, std::min(rest, most_y), 1);
      if (rest > 1 && ny > 1) consider(z, 1, std::min(rest, ny));
    }
  }

  // `to_spare`: rows that the cache holds beside those that are in use, row by row.
  template <class Buffers>
  void allot_rows(std::int32_t to_spare, std::ptrdiff_t line) {
    by_rows = true;
    block = std::clamp(1 + to_spare / buffers, 4, 16);
    strip_size = line;  // a pack may read before the first row
    for (int b = 0; b < buffers; ++b) {
      SweepBuffer& of_stage = buffer[b];
      of_stage.producer = Buffers::producer(b);
      if (Buffers::planes(b, 1) == 0) continue;
      of_stage.planes = Buffers::planes(b, 1) + block - 1;
      of_stage.ring = strip_size;
      strip_size += of_stage.planes * row;
    }
    strip_size += line;
  }

  // Where the buffers lie in the memory of a part: the rings of each strip, then the seams.
  template <class Buffers>
  void allot(std::ptrdiff_t line) {
    std::int32_t const rows = (layout.ny + parts_y - 1) / parts_y;
    std::int32_t const longest = (rows + strips - 1) / strips;
    ring_rows = std::min(2 * block, longest) + 2 * stages;
    seam_planes = (layout.nz + parts_z - 1) / parts_z + 2 * stages;
    bool const all_planes = parts_z == 1 && !Axis(layout, 2).wraps;
    std::int32_t const most_planes = all_planes ? layout.nz : seam_planes;
    strip_size = seam_size = line;  // a pack may read before the first row
    for (int b = 0; b < buffers; ++b) {
      SweepBuffer& of_stage = buffer[b];
      of_stage.producer = Buffers::producer(b);
      of_stage.planes = std::min(Buffers::planes(b, lag), most_planes);
      if (of_stage.planes == 0) continue;
      of_stage.seam_rows = Buffers::planes(b, 1) - 1;  // blocks follow each other row by row
      of_stage.ring = strip_size;
      strip_size += of_stage.planes * ring_rows * row;
      of_stage.seam = seam_size;
      if (blocks(rows) > 1) seam_size += of_stage.seam_rows * (seam_planes + of_stage.planes) * row;
    }
    strip_size += line;
    seam_size += line;
  }
};

/// Fills the buffers: the few numbers that belong to no site must not trap or be denormal. One task
/// per strip, so that the thread of a strip is the first to touch its memory.
template <class Real>
struct FillSweepBuffers {
  Real* data;
  SweepPlan plan;

  void operator()(std::int64_t task) const {
    std::int64_t const part = task / plan.strips, strip = task % plan.strips;
    bool const last = strip + 1 == plan.strips;
    std::fill_n(data + part * plan.part_size() + strip * plan.strip_size,
                plan.strip_size + (last ? plan.seam_size : 0), Real(0));
  }
};

/// One strip of one part of a sweep, at one of its blocks.
template <class Real>
struct SweepPart {
  SweepPlan const& plan;
  SweepRange y, z;
  Real* memory;
  std::int32_t strip, blocks, block = 0;

  SweepPart(SweepPlan const& whole, Real* buffers, std::int64_t part, std::int32_t of_part)
      : plan(whole),
        y(whole.range_y(part)),
        z(whole.range_z(part)),
        memory(buffers + part * whole.part_size()),
        strip(of_part),
        blocks(whole.blocks(y.end - y.begin)) {}

  /// The steps of a strip: through all planes for each block, each stage at its own plane.
  std::int64_t steps() const { return std::int64_t(blocks) * steps_per_block(); }
  /// The plane of stage 0 at such a step, whose block this is from now on.
  std::int32_t begin_step(std::int64_t step) {
    block = static_cast<std::int32_t>(step / steps_per_block());
    return z.low(0) + static_cast<std::int32_t>(step % steps_per_block());
  }

  /// A stage works on rows low .. high - 1. At the ends of blocks it follows the stage before it at
  /// one row.
  std::int32_t low(int stage) const { return low_of(strip, stage); }
  std::int32_t high(int stage) const {
    if (strip + 1 < plan.strips) return bound(strip + 1);
    return block + 1 == blocks ? y.high(stage) : bound(strip + 1) - stage;
  }

  /// Plane z of a buffer.
  CAYSPIN_DETAIL_NOINLINE PlaneRows<Real> rows(int number, std::int32_t at_z) const {
    SweepBuffer const& buffer = plan.buffer[number];
    std::int32_t const from_begin = at_z - z.low(0);
    bool const ends_at_seam = strip + 1 == plan.strips && block + 1 < blocks;
    std::int32_t const first = low(buffer.producer);
    std::int32_t const last = high(buffer.producer) - (ends_at_seam ? buffer.seam_rows : 0);
    auto const ring = [&](std::int32_t of_strip) {
      return memory + of_strip * plan.strip_size + buffer.ring +
             from_begin % buffer.planes * plan.ring_rows * plan.row;
    };
    // A seam's planes move on by `planes` from block to block. So planes of the block before are
    // not overwritten while they are still needed.
    auto const seam = [&](std::int32_t of_block) {
      std::int32_t const slots = plan.seam_planes + buffer.planes;
      std::int32_t slot = (from_begin - of_block * buffer.planes) % slots;
      if (slot < 0) slot += slots;
      return memory + plan.strips * plan.strip_size + buffer.seam +
             slot * buffer.seam_rows * plan.row;
    };
    return {strip > 0 ? ring(strip - 1) + (first - low_of(strip - 1, buffer.producer)) * plan.row
                      : seam(block - 1) + buffer.seam_rows * plan.row,
            ring(strip),
            strip + 1 < plan.strips ? ring(strip + 1) : seam(block),
            first,
            last,
            plan.row,
            plan.pitch};
  }

 private:
  std::int32_t steps_per_block() const { return z.end + plan.lag * (plan.stages - 1) - z.low(0); }
  std::int32_t low_of(std::int32_t of_strip, int stage) const {
    if (of_strip > 0) return bound(of_strip);
    return block == 0 ? y.low(stage) : bound(0) - stage;
  }
  /// Where a strip begins in this block.
  std::int32_t bound(std::int32_t of_strip) const {
    std::int64_t const i = std::int64_t(block) * plan.strips + of_strip;
    return y.begin +
           static_cast<std::int32_t>((y.end - y.begin) * i / (std::int64_t(blocks) * plan.strips));
  }
};

}  // namespace cayspin::detail
