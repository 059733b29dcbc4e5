// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/device_site.hpp>
#include <cayspin/detail/device_tiles.hpp>
#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/site.hpp>

#include <algorithm>
#include <concepts>
#include <cstdint>
#include <string>

namespace cayspin::inline v0_2::detail {

/// Long rows are cut into pieces of at least this many sites, so that threads can share a row.
inline constexpr std::int32_t sites_per_task = 4096;

inline std::int32_t tasks_per_row(RowLayout const& layout) {
  return std::max<std::int32_t>(1, layout.nx / sites_per_task);
}

template <std::floating_point Real>
std::int32_t pack_count(RowLayout const& layout) {
  return (layout.nx + host_lanes<Real> - 1) / host_lanes<Real>;
}

/// Calls functor(site) for packs begin .. end - 1 of a row.
template <class Value, class Functor>
KOKKOS_FORCEINLINE_FUNCTION void for_each_pack(Row const& row, std::int32_t begin, std::int32_t end,
                                               Functor&& functor) {
  constexpr std::int32_t lanes = lanes_of<Value>;
  for (std::int32_t pack = begin; pack < end; ++pack) functor(Site<Value>(row, pack * lanes));
}

/// Packs pack_begin .. pack_end - 1 of each of the rows y_begin .. y_end - 1 of plane z.
struct RowBlock {
  std::int32_t z, y_begin, y_end, pack_begin, pack_end;
};

/// The blocks that host tasks work on: one or more rows of a plane, or part of a long row. Unless
/// planes are small, each block is large enough to hide the cost of starting a task; on large
/// lattices there are enough blocks for many threads.
class RowBlocks {
 public:
  RowBlocks(RowLayout const& layout, std::int32_t packs, RowRange const& rows)
      : rows_(rows), packs_(packs), parts_of_row_(tasks_per_row(layout)) {
    auto const sites = std::clamp<std::int64_t>(layout.sites() / 1024, 512, 16384);
    auto const blocks = std::int64_t(layout.nx) * rows.ny() / sites;
    parts_of_plane_ = static_cast<std::int32_t>(
        std::clamp<std::int64_t>(parts_of_row_ > 1 ? rows.ny() : blocks, 1, rows.ny()));
  }

  std::int64_t count() const { return std::int64_t(rows_.nz()) * parts_of_plane_ * parts_of_row_; }

  RowBlock operator()(std::int64_t task) const {
    if (parts_of_row_ == 1 && parts_of_plane_ == 1)  // saves divisions, which are slow
      return {static_cast<std::int32_t>(rows_.z_begin + task), rows_.y_begin, rows_.y_end, 0,
              packs_};
    auto const cut = [](std::int32_t extent, std::int64_t part, std::int32_t parts) {
      return static_cast<std::int32_t>(extent * part / parts);
    };
    auto const in_row = task % parts_of_row_, in_plane = task / parts_of_row_ % parts_of_plane_;
    return {static_cast<std::int32_t>(rows_.z_begin + task / parts_of_row_ / parts_of_plane_),
            rows_.y_begin + cut(rows_.ny(), in_plane, parts_of_plane_),
            rows_.y_begin + cut(rows_.ny(), in_plane + 1, parts_of_plane_),
            cut(packs_, in_row, parts_of_row_), cut(packs_, in_row + 1, parts_of_row_)};
  }

 private:
  RowRange rows_;
  std::int32_t packs_, parts_of_row_, parts_of_plane_;
};

/// Host loop. One compiled body serves all host spaces, so that their results are bitwise
/// identical.
template <class Real, class Functor>
struct RowLoop {
  Functor functor;
  RowLayout layout;
  RowBlocks blocks;

  CAYSPIN_DETAIL_NOINLINE void operator()(std::int64_t task) const {
    Functor local = functor;
    auto const block = blocks(task);
    for (std::int32_t y = block.y_begin; y < block.y_end; ++y)
      for_each_pack<Pack<Real>>(Row(layout, y, block.z), block.pack_begin, block.pack_end, local);
    streaming_fence();
  }
};

/// Returns row number `row` of a range.
KOKKOS_FORCEINLINE_FUNCTION Row row_of(RowLayout const& layout, RowRange const& rows,
                                       std::int64_t row) {
  return {layout, static_cast<std::int32_t>(rows.y_begin + row % rows.ny()),
          static_cast<std::int32_t>(rows.z_begin + row / rows.ny())};
}

/// Device loop: calls body(layout, x, y, z) for the sites of a thread.
template <class Index, class Body>
struct TileLoop {
  Body body;
  DeviceLayout<Index> layout;
  DeviceTiles tiles;

  KOKKOS_FUNCTION void operator()(Index thread) const {
    tiles.for_each(
        thread, [this](std::int32_t x, std::int32_t y, std::int32_t z) { body(layout, x, y, z); });
  }
};

/// Runs a TileLoop with the shortest index type that suffices.
template <class Exec, class Body>
void for_each_tile(Exec const& exec, std::string const& label, RowLayout const& layout,
                   DeviceTiles const& tiles, Body const& body) {
  auto const run = [&]<class Index>(Index threads) {
    Kokkos::parallel_for(label,
                         Kokkos::RangePolicy<Exec, Kokkos::IndexType<Index>>(exec, 0, threads),
                         TileLoop<Index, Body>{body, DeviceLayout<Index>(layout), tiles});
  };
  std::int64_t const threads = tiles.thread_count();
  if (DeviceLayout<std::int32_t>::reaches(layout, threads))
    run(static_cast<std::int32_t>(threads));
  else
    run(threads);
}

/// Device loop body of for_each_site.
template <class Real, class Functor>
struct OnDeviceSite {
  Functor functor;

  template <class Index>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(DeviceLayout<Index> const& layout, std::int32_t x,
                                              std::int32_t y, std::int32_t z) const {
    functor(DeviceSite<Real, Index>(layout, x, y, z));
  }
};

/// Calls functor(site) for all sites of `rows`, in parallel. `functor` is a plain struct whose call
/// operator is a template over the type of the site.
template <class Real, class Exec, class Functor>
void for_each_site(Exec const& exec, std::string const& label, RowLayout const& layout,
                   Functor const& functor, RowRange const& rows) {
  if constexpr (is_host_execution<Exec>) {
    RowBlocks const blocks(layout, pack_count<Real>(layout), rows);
    for_each_task(exec, label, blocks.count(), layout.sites(),
                  RowLoop<Real, Functor>{functor, layout, blocks});
  } else {
    for_each_tile(exec, label, layout, DeviceTiles(layout.nx, rows),
                  OnDeviceSite<Real, Functor>{functor});
  }
}
/// Calls functor(site) for all sites, ghosts included.
template <class Real, class Exec, class Functor>
void for_each_site(Exec const& exec, std::string const& label, RowLayout const& layout,
                   Functor const& functor) {
  for_each_site<Real>(exec, label, layout, functor, layout.all());
}

/// Host loop that visits all sites of a pack's columns before those of the next pack.
template <class Real, class Functor>
struct ColumnLoop {
  Functor functor;
  RowLayout layout;
  std::int64_t packs_of_task;

  /// Each task is large enough to hide the cost of starting it.
  ColumnLoop(Functor const& of_site, RowLayout const& rows)
      : functor(of_site), layout(rows), packs_of_task(1 + 512 / (rows.rows() * host_lanes<Real>)) {}
  std::int64_t tasks() const {
    return (pack_count<Real>(layout) + packs_of_task - 1) / packs_of_task;
  }

  CAYSPIN_DETAIL_NOINLINE void operator()(std::int64_t task) const {
    Functor local = functor;
    auto const end = std::min<std::int64_t>((task + 1) * packs_of_task, pack_count<Real>(layout));
    for (std::int64_t pack = task * packs_of_task; pack < end; ++pack)
      for (std::int32_t z = 0; z < layout.nz; ++z)
        for (std::int32_t y = 0; y < layout.ny; ++y)
          local(Site<Pack<Real>>(Row(layout, y, z), pack * host_lanes<Real>));
    streaming_fence();
  }
};

/// Like for_each_site, only on hosts, for functors that are faster along columns, the sites with
/// equal x.
template <class Real, class Exec, class Functor>
void for_each_site_by_columns(Exec const& exec, std::string const& label, RowLayout const& layout,
                              Functor const& functor) {
  static_assert(is_host_execution<Exec>, "Device threads have one site each.");
  ColumnLoop<Real, Functor> const loop(functor, layout);
  for_each_task(exec, label, loop.tasks(), layout.sites(), loop);
}

}  // namespace cayspin::inline v0_2::detail
