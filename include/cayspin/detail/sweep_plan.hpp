// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/rows.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>

// Divides the lattice of a sweep among threads, and each part into blocks of rows whose buffers fit
// into the cache. Seams keep the last rows of a block, because the next block reads them. In a
// lattice of one plane that is not cut into strips, stages follow each other by rows instead
// (row_sweep.hpp).
namespace cayspin::inline v0_2::detail {

/// The planes or rows of one part. At each end of the part, unless it is an open end of the
/// lattice, a stage works on one plane or row more than the stage after it. The part beyond that
/// end computes these planes or rows, too.
template <class AlongAxis>
struct SweepRange {
  std::int32_t begin, end, stages;
  AlongAxis axis;

  std::int32_t low(int stage) const { return begin - (ends_inside(begin) ? ahead(stage) : 0); }
  std::int32_t high(int stage) const { return end + (ends_inside(end) ? ahead(stage) : 0); }

 private:
  bool ends_inside(std::int32_t i) const { return !axis.is_cut(i); }
  std::int32_t ahead(int stage) const { return stages - 1 - stage; }
};

/// A buffer: a ring of `planes` planes of rows, and a seam of `seam_rows` rows for each plane of
/// the part. If stages follow each other by rows, it is only a ring of `planes` rows.
struct SweepBuffer {
  std::int32_t producer = 0, planes = 0, seam_rows = 0;
  std::ptrdiff_t ring = 0, seam = 0;  // offsets in the strip, and in the part's seams
};

/// The division of a lattice into independent parts, along z and y. A part may be cut into strips
/// along y, one for each of several threads. These threads pass through the planes together, and
/// each reads rows of the strips beside its own.
struct SweepPlan {
  static constexpr int most_stages = 13;

  RowLayout layout;
  std::int32_t stages = 1, buffers = 0;
  std::int32_t parts_y = 1, parts_z = 1, strips = 1;
  std::int32_t lag = 1;  // planes between a stage and the one before it
  bool by_rows = false;
  // A block has at least this many rows of each strip, and fewer than twice as many; a strip with
  // fewer rows is one block. If stages follow each other by rows: the number of rows on which a
  // stage works in one tick.
  std::int32_t block = 1;
  std::int32_t ring_rows = 0, seam_planes = 0;
  // Strides in a buffer: `pitch` from component to component, `row` from row to row.
  std::ptrdiff_t pitch = 0, row = 0;
  std::ptrdiff_t strip_size = 0, seams_size = 0;  // numbers in a strip, and in a part's seams
  SweepBuffer buffer[3 * most_stages];

  std::int64_t parts() const { return std::int64_t(parts_y) * parts_z; }
  std::int64_t tasks() const { return parts() * strips; }
  /// Returns how many numbers the memory of a part holds: first its strips, then its seams.
  std::ptrdiff_t part_size() const { return strips * strip_size + seams_size; }
  /// Returns how many numbers all buffers hold.
  std::size_t size() const { return static_cast<std::size_t>(parts() * part_size()); }

  SweepRange<Axis> range_y(std::int64_t part) const {
    return range(static_cast<std::int32_t>(part % parts_y), parts_y, layout.own.y_begin,
                 layout.own.ny(), Axis(layout, 1));
  }
  SweepRange<PlaneAxis> range_z(std::int64_t part) const {
    return range(static_cast<std::int32_t>(part / parts_y), parts_z, layout.own.z_begin,
                 layout.own.nz(), PlaneAxis(layout));
  }
  /// Returns by how many planes a seam shifts from block to block, so that planes of the previous
  /// block are not overwritten while a strip some planes behind still needs them.
  std::int32_t seam_shift(SweepBuffer const& of_stage) const {
    return of_stage.planes + 2 * (lag - 1);
  }
  /// Returns the number of blocks in each strip of a part that has this many rows.
  std::int32_t blocks(std::int32_t rows) const { return std::max(1, rows / strips / block); }

  /// Makes a plan for this many threads. Unless stages follow each other by rows, `block` is the
  /// largest number of rows for which the buffers and the spins in use fit into `cache` bytes, but
  /// at least 2 * stages.
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
    auto const planes_in_use = [&](std::int32_t apart) {
      std::int32_t planes = apart * plan.stages + 2;  // of the spins at the start of the step
      for (int b = 0; b < plan.buffers; ++b) planes += Buffers::planes(b, apart);
      return planes;
    };
    auto const rows_in_cache =
        static_cast<std::int32_t>(cache / (static_cast<std::size_t>(plan.row) * sizeof(Real)));
    // Returns rows per block if stages are `apart` planes apart.
    auto const rows_per_block = [&](std::int32_t apart) {
      return std::max(2 * plan.stages, std::min(rows_in_cache / planes_in_use(apart), layout.ny));
    };
    plan.cut(threads, rows_per_block(1), rows_per_block(lag_of_strips));
    if (layout.nz == 1 && plan.strips == 1)
      plan.allot_rows<Buffers>(rows_in_cache - planes_in_use(1), line);
    else
      plan.allot<Buffers>(line);
    return plan;
  }

 private:
  /// A strip reads rows of its neighbours at its own plane, so a lag of 1 would do. With 2,
  /// neighbours may be one plane apart, so that they rarely wait for each other.
  static constexpr std::int32_t lag_of_strips = 2;
  /// Cost of one synchronisation between two strips: the number of sites that could be stepped in
  /// that time.
  static constexpr double meeting = 100;

  template <class AlongAxis>
  SweepRange<AlongAxis> range(std::int32_t part, std::int32_t parts, std::int32_t begin,
                              std::int32_t extent, AlongAxis const& axis) const {
    auto const bound = [&](std::int32_t i) {
      return begin + static_cast<std::int32_t>(std::int64_t(extent) * i / parts);
    };
    return {bound(part), bound(part + 1), stages, axis};
  }

  // Finds the fastest division among at most `threads` threads. Strips are not considered if each
  // thread can have its own part and the parts repeat little work. Of divisions that take equal
  // times, that with the most parts along z is chosen, because such parts are far apart in memory.
  void cut(int threads, std::int32_t block_of_parts, std::int32_t block_of_strips) {
    std::int32_t const ny = layout.own.ny(), nz = layout.own.nz();
    // Returns the cost of the largest of `parts` parts, in planes or rows. At each end that is
    // shared with another part, stages repeat (stages - 1) / 2 planes or rows on average. Repeated
    // ones also move memory, so each counts as one and a half.
    auto const largest = [&](std::int32_t extent, std::int32_t parts) {
      return (extent + parts - 1) / parts + 0.75 * std::min(parts - 1, 2) * (stages - 1);
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
    auto const little = [&](std::int32_t z, std::int32_t y) {
      return double(stages - 1) * (z - 1) / nz + double(stages - 1) * (y - 1) / ny < 0.05;
    };
    std::int32_t const most_z = std::min(threads, std::max(1, nz / (2 * stages)));
    std::int32_t const most_y = std::max(1, ny / (2 * stages));
    for (std::int32_t z = most_z; z >= 1; --z) consider(z, std::min(threads / z, most_y), 1);
    if (parts() == threads && little(parts_z, parts_y)) return;
    for (std::int32_t z = most_z; z >= 1; --z) {
      std::int32_t const most_strips = std::min(threads / z, ny);
      bool const is_needed = z <= (threads + ny - 1) / ny;  // to give all threads work
      if (most_strips > 1 && (is_needed || little(z, 1))) consider(z, 1, most_strips);
    }
  }

  // `to_spare`: how many rows fit into the cache in addition to those that are always in use.
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

  // Places the buffers in the memory of a strip, and the seams after the last strip of a part.
  template <class Buffers>
  void allot(std::ptrdiff_t line) {
    std::int32_t const rows = (layout.ny + parts_y - 1) / parts_y;
    std::int32_t const longest = (rows + strips - 1) / strips;
    ring_rows = std::min(2 * block, longest) + 2 * stages;
    seam_planes = (layout.nz + parts_z - 1) / parts_z + 2 * stages;
    std::ptrdiff_t size = line;  // a pack may read before the first row
    bool const all_planes = strips == 1 && parts_z == 1 && !PlaneAxis(layout).wraps;
    std::int32_t const most_planes = all_planes ? layout.nz : seam_planes;
    for (int b = 0; b < buffers; ++b) {
      SweepBuffer& of_stage = buffer[b];
      of_stage.producer = Buffers::producer(b);
      of_stage.planes = std::min(Buffers::planes(b, lag), most_planes);
      if (of_stage.planes == 0) continue;
      of_stage.seam_rows = Buffers::planes(b, 1) - 1;  // at a seam, stages are one row apart
      of_stage.ring = size;
      size += of_stage.planes * ring_rows * row;
      if (blocks(rows) == 1) continue;
      of_stage.seam = seams_size;
      seams_size += of_stage.seam_rows * (seam_planes + seam_shift(of_stage)) * row;
    }
    strip_size = size + line;
    if (seams_size > 0) seams_size += line;
  }
};

/// Functor that fills the buffers with zeros, because arbitrary numbers in the padding could trap
/// or be denormal. There is one task per strip, so that each thread is the first to touch the
/// memory of its strip.
template <class Real>
struct FillSweepBuffers {
  Real* data;
  SweepPlan plan;

  void operator()(std::int64_t task) const {
    std::int64_t const part = task / plan.strips, strip = task % plan.strips;
    bool const is_last = strip + 1 == plan.strips;
    std::fill_n(data + part * plan.part_size() + strip * plan.strip_size,
                plan.strip_size + (is_last ? plan.seams_size : 0), Real(0));
  }
};

/// One strip of one part of a sweep, within one block.
template <class Real>
struct SweepPart {
  SweepPlan const& plan;
  SweepRange<Axis> y;
  SweepRange<PlaneAxis> z;
  Real* memory;
  std::int32_t strip, blocks, steps_per_block;

  SweepPart(SweepPlan const& whole, Real* buffers, std::int64_t part, std::int32_t of_part)
      : plan(whole),
        y(whole.range_y(part)),
        z(whole.range_z(part)),
        memory(buffers + part * whole.part_size()),
        strip(of_part),
        blocks(whole.blocks(y.end - y.begin)),
        steps_per_block(z.end + whole.lag * (whole.stages - 1) - z.low(0)) {}

  /// Returns the number of steps of a strip. Each block takes one pass through the planes; in a
  /// step, each stage works on its own plane.
  std::int64_t steps() const { return std::int64_t(blocks) * steps_per_block; }
  /// Moves to a step, and to the block that contains it. Returns the plane of stage 0 in this step.
  std::int32_t begin_step(std::int64_t step) {
    block_ = static_cast<std::int32_t>(step / steps_per_block);
    for (std::int32_t i = 0; i < 3; ++i) bounds_[i] = bound(strip - 1 + i);
    return z.low(0) + static_cast<std::int32_t>(step % steps_per_block);
  }

  /// A stage works on rows low(stage) .. high(stage) - 1. At the boundary of two blocks, the rows
  /// of each stage begin and end one row earlier than those of the stage before it.
  std::int32_t low(int stage) const {
    if (!begins_block()) return bounds_[1];
    return block_ == 0 ? y.low(stage) : bounds_[1] - stage;
  }
  std::int32_t high(int stage) const {
    if (!ends_block()) return bounds_[2];
    return block_ + 1 == blocks ? y.high(stage) : bounds_[2] - stage;
  }

  /// Returns plane at_z of a buffer.
  CAYSPIN_DETAIL_NOINLINE PlaneRows<Real> rows(int number, std::int32_t at_z) const {
    SweepBuffer const& buffer = plan.buffer[number];
    int const stage = buffer.producer;
    std::int32_t const from_begin = at_z - z.low(0);
    std::int32_t const first = low(stage);
    bool const ends_at_seam = ends_block() && block_ + 1 < blocks;
    std::int32_t const last = high(stage) - (ends_at_seam ? buffer.seam_rows : 0);
    // Continues in the ring where the previous block ended, so that planes of that block are not
    // overwritten while a neighbour still reads them.
    std::int32_t const turn = (from_begin + block_ * steps_per_block) % buffer.planes;
    Real* const ring =
        memory + strip * plan.strip_size + buffer.ring + turn * plan.ring_rows * plan.row;
    Real *before = ring, *after = ring;  // not read unless set below
    if (!begins_block()) {
      // In the first strip of a block, the first row depends on the stage.
      bool const is_second = strip == 1;
      std::int32_t const begin = is_second ? low_of_first(stage) : bounds_[0];
      before = ring - plan.strip_size + (first - begin) * plan.row;
    } else if (block_ > 0) {
      before = seam(buffer, block_ - 1, from_begin) + buffer.seam_rows * plan.row;
    }
    if (!ends_block())
      after = ring + plan.strip_size;
    else if (ends_at_seam)
      after = seam(buffer, block_, from_begin);
    return {before, ring, after, first, last, plan.row, plan.pitch};
  }

 private:
  bool begins_block() const { return strip == 0; }
  bool ends_block() const { return strip + 1 == plan.strips; }

  /// Returns the first row of a strip in this block.
  std::int32_t bound(std::int32_t of_strip) const {
    std::int64_t const i = std::int64_t(block_) * plan.strips + of_strip;
    return y.begin +
           static_cast<std::int32_t>((y.end - y.begin) * i / (std::int64_t(blocks) * plan.strips));
  }
  std::int32_t low_of_first(int stage) const {
    return block_ == 0 ? y.low(stage) : bounds_[0] - stage;
  }

  Real* seam(SweepBuffer const& buffer, std::int32_t of_block, std::int32_t from_begin) const {
    std::int32_t const slots = plan.seam_planes + plan.seam_shift(buffer);
    std::int32_t slot = (from_begin - of_block * plan.seam_shift(buffer)) % slots;
    if (slot < 0) slot += slots;
    return memory + plan.strips * plan.strip_size + buffer.seam +
           slot * buffer.seam_rows * plan.row;
  }

  std::int32_t block_ = 0;
  std::int32_t bounds_[3] = {};  // first rows of the previous strip, this one and the next
};

}  // namespace cayspin::inline v0_2::detail
