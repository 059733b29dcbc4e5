// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/division_by.hpp>
#include <cayspin/row_layout.hpp>

#include <Kokkos_Core.hpp>

#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// Divides a film or a chain into tiles, one for each team of a device, for steps of several
/// stages. Each thread of a team has one site. The tiles overlap: a team also has the sites around
/// its own whose early stages it needs.
class TilesOfSteps {
 public:
  /// On larger lattices the repeated work takes longer than launches.
  static constexpr std::int64_t most_sites = 1 << 15;
  static constexpr std::int32_t most_threads = 512;

  TilesOfSteps(RowLayout const& layout, std::int32_t stages)
      : nx_(layout.nx),
        ny_(layout.ny),
        depth_(layout.replica_planes),
        periodic_{layout.periodic[0], layout.periodic[1]},
        around_{stages - 1, layout.ny > 1 ? stages - 1 : 0},
        width_bits_(layout.ny > 1 ? 4 : 6),
        height_bits_(layout.ny > 1 ? 4 : 0),
        own_{(1 << width_bits_) - 2 * around_[0], (1 << height_bits_) - 2 * around_[1]},
        per_row_(parts(nx_, own_[0])),
        per_plane_(parts(ny_, own_[1])),
        count_(per_row_ * per_plane_ * (layout.nz / depth_)),
        by_row_(per_row_),
        by_plane_(per_plane_) {}

  /// Returns true if all sites of a tile have a thread, and steps in tiles are expected to be
  /// faster than a launch for each stage.
  static bool suit(RowLayout const& layout, std::int32_t stages) {
    return layout.part == nullptr && layout.sites() <= most_sites &&
           layout.replica_planes <= most_threads &&
           TilesOfSteps(layout, stages).threads() <= most_threads;
  }

  std::int32_t count() const { return count_; }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t threads() const {
    return depth_ << (width_bits_ + height_bits_);
  }
  /// Returns the distance between the threads of neighbours along y.
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t row() const {
    return height_bits_ > 0 ? 1 << width_bits_ : 0;
  }

  /// The site of a thread.
  struct Place {
    std::int32_t x, y, z;
    std::int32_t stages;                 // how many of its first stages the team needs
    std::int32_t before = 0, after = 0;  // from its thread to those of its neighbours along z
  };
  KOKKOS_FORCEINLINE_FUNCTION Place place(std::int32_t tile, std::int32_t thread) const {
    std::int32_t const row = by_row_.quotient(tile), replica = by_plane_.quotient(row);
    std::int32_t const line = thread >> width_bits_, plane = line >> height_bits_;
    std::int32_t const i = thread - (line << width_bits_), j = line - (plane << height_bits_);
    std::int32_t const x = (tile - row * per_row_) * own_[0] + i - around_[0];
    std::int32_t const y = (row - replica * per_plane_) * own_[1] + j - around_[1];
    std::int32_t const halo = around_[0];
    std::int32_t to_edge = Kokkos::min(halo, Kokkos::min(i, (1 << width_bits_) - 1 - i));
    if (around_[1] > 0) to_edge = Kokkos::min(to_edge, Kokkos::min(j, (1 << height_bits_) - 1 - j));
    bool const own = to_edge == halo && x < nx_ && y < ny_;
    Place place{wrapped(x, nx_, 0), wrapped(y, ny_, 1), replica * depth_ + plane,
                own ? halo + 1 : Kokkos::min(to_edge + 1, halo)};
    if (place.x < 0 || place.y < 0) place.stages = 0;
    std::int32_t const area = 1 << (width_bits_ + height_bits_);
    place.before = (plane > 0 ? -1 : depth_ - 1) * area;
    place.after = (plane + 1 < depth_ ? 1 : 1 - depth_) * area;
    return place;
  }

 private:
  static std::int32_t parts(std::int32_t extent, std::int32_t part) {
    return (extent + part - 1) / part;
  }
  // Returns -1 past an open end, and beyond what the sites at a periodic end need.
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t wrapped(std::int32_t i, std::int32_t extent,
                                                   int axis) const {
    if (i >= 0 && i < extent) return i;
    if (!periodic_[axis] || i >= extent + around_[axis]) return -1;
    while (i < 0) i += extent;
    while (i >= extent) i -= extent;
    return i;
  }

  std::int32_t nx_, ny_, depth_;
  bool periodic_[2];
  std::int32_t around_[2], width_bits_, height_bits_, own_[2], per_row_, per_plane_, count_;
  DivisionBy by_row_, by_plane_;
};

}  // namespace cayspin::inline v0_2::detail
