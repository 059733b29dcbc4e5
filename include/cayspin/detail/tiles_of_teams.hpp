// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/device_tiles.hpp>
#include <cayspin/row_layout.hpp>

#include <algorithm>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// Divides a lattice into tiles, one for each team of a device. Each thread of a team has one x and
/// one y, and walks along z. The tiles overlap: the threads at the border of a tile belong to
/// sites of the tiles beside it, or to none.
class TilesOfTeams {
 public:
  static constexpr std::int32_t width = 32, height = 12;  // in threads, with the border
  static constexpr std::int32_t threads = width * height;

  explicit TilesOfTeams(RowLayout const& layout)
      : nx_(layout.nx),
        ny_(layout.ny),
        planes_(layout.replica_planes),
        periodic_{layout.periodic[0], layout.periodic[1], layout.periodic[2]},
        per_row_(parts(nx_, width - 2)),
        per_plane_(parts(ny_, height - 2)),
        walk_(walk(layout.nz / planes_)),
        per_replica_(parts(planes_, walk_)),
        count_(std::int64_t(per_row_) * per_plane_ * per_replica_ * (layout.nz / planes_)),
        by_row_(static_cast<std::uint32_t>(per_row_)),
        by_plane_(static_cast<std::uint32_t>(per_plane_)),
        by_replica_(static_cast<std::uint32_t>(per_replica_)) {}

  std::int64_t count() const { return count_; }

  /// The sites of a thread.
  struct Column {
    std::int32_t x, y;
    std::int32_t first, begin, end;  // plane 0 of the replica; planes begin .. end - 1 after it
    bool there;                      // false if no site of the lattice has this x and y
    bool own;                        // false at the border
  };
  KOKKOS_FORCEINLINE_FUNCTION Column column(std::int32_t tile, std::int32_t thread) const {
    std::int32_t const row = quotient(by_row_, tile), chunk = quotient(by_plane_, row),
                       replica = quotient(by_replica_, chunk);
    std::int32_t const i = thread % width, j = thread / width;
    Column column;
    column.x = (tile - row * per_row_) * (width - 2) + i - 1;
    column.y = (row - chunk * per_plane_) * (height - 2) + j - 1;
    column.own =
        i > 0 && i < width - 1 && column.x < nx_ && j > 0 && j < height - 1 && column.y < ny_;
    column.x = wrapped(column.x, nx_, 0);
    column.y = wrapped(column.y, ny_, 1);
    column.there = column.x >= 0 && column.y >= 0;
    column.first = replica * planes_;
    column.begin = (chunk - replica * per_replica_) * walk_;
    column.end = Kokkos::min(column.begin + walk_, planes_);
    return column;
  }
  /// Returns the plane of a replica at -1 .. planes; -1 past an open end.
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t plane(std::int32_t z) const {
    return wrapped(z, planes_, 2);
  }

 private:
  static std::int32_t parts(std::int32_t extent, std::int32_t part) {
    return (extent + part - 1) / part;
  }
  // Long walks repeat less at their ends, but a device needs some hundred teams.
  std::int32_t walk(std::int32_t replicas) const {
    std::int32_t walk = 32;
    while (walk > 8 && std::int64_t(per_row_) * per_plane_ * parts(planes_, walk) * replicas < 512)
      walk /= 2;
    return std::min(walk, planes_);
  }
  KOKKOS_FORCEINLINE_FUNCTION static std::int32_t quotient(QuickDivision const& by,
                                                           std::int32_t number) {
    return static_cast<std::int32_t>(by(static_cast<std::uint32_t>(number)));
  }
  // Returns -1 past an open end, and beyond the neighbours of a periodic end.
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t wrapped(std::int32_t i, std::int32_t extent,
                                                   int axis) const {
    if (i >= 0 && i < extent) return i;
    if (!periodic_[axis] || i > extent) return -1;
    return i < 0 ? extent - 1 : 0;
  }

  std::int32_t nx_, ny_, planes_;
  bool periodic_[3];
  std::int32_t per_row_, per_plane_, walk_, per_replica_;
  std::int64_t count_;
  QuickDivision by_row_, by_plane_, by_replica_;
};

}  // namespace cayspin::inline v0_2::detail
