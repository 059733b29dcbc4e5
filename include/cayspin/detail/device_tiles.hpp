// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>
#include <cayspin/row_layout.hpp>

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>

// Assigns sites to the threads of a device. Each group of threads_of_tile threads shares a tile of
// rows, and each thread walks along z. So most neighbours along y and z come from the cache of the
// multiprocessor, and x and y are found once for all sites of a thread.
namespace cayspin::inline v0_2::detail {

/// Divides numbers below 2^31 by a positive divisor that is known at launch, with a multiplication
/// and a shift.
class QuickDivision {
 public:
  explicit QuickDivision(std::uint32_t divisor)
      : shift_(static_cast<std::int32_t>(std::bit_width(divisor)) - 1),
        factor_(static_cast<std::uint32_t>(
            std::min<std::uint64_t>((std::uint64_t(1) << (32 + shift_)) / divisor, UINT32_MAX))) {}

  KOKKOS_FORCEINLINE_FUNCTION std::uint32_t operator()(std::uint32_t number) const {
    return static_cast<std::uint32_t>((std::uint64_t(number + 1) * factor_) >> 32) >> shift_;
  }

 private:
  std::int32_t shift_;
  std::uint32_t factor_;
};

class DeviceTiles {
 public:
  /// Divides the first `nx` places of each row in `rows` into tiles. A thread works on one plane,
  /// or on up to eight if the lattice fills a large device many times.
  DeviceTiles(std::int32_t nx, RowRange const& rows)
      : nx_(nx),
        y_begin_(rows.y_begin),
        y_end_(rows.y_end),
        z_begin_(rows.z_begin),
        z_end_(rows.z_end),
        walk_(std::clamp<std::int32_t>(
            static_cast<std::int32_t>(std::int64_t(nx) * rows.count() >> 19), 1, 8)),
        x_bits_(bits_of(nx, rows.ny() > 1 ? 5 : 7)),
        per_row_(tiles(nx, 1 << x_bits_)),
        per_plane_(tiles(rows.ny(), threads >> x_bits_)),
        planes_(tiles(rows.nz(), walk_)),
        by_row_(std::max(per_row_, 1u)),
        by_plane_(std::max(per_plane_, 1u)) {}

  std::int64_t thread_count() const {
    return std::int64_t(threads) * per_row_ * per_plane_ * planes_;
  }

  /// Calls body(x, y, z) for the sites of a thread.
  template <class Thread, class Body>
  KOKKOS_FORCEINLINE_FUNCTION void for_each(Thread thread, Body const& body) const {
    auto const number = static_cast<std::uint32_t>(thread / threads);
    std::uint32_t const row = by_row_(number), plane = by_plane_(row);
    auto const lane = static_cast<std::uint32_t>(thread) % threads;
    auto const x = static_cast<std::int32_t>(((number - row * per_row_) << x_bits_) +
                                             (lane & ((1u << x_bits_) - 1)));
    auto const y =
        y_begin_ + static_cast<std::int32_t>((row - plane * per_plane_) * (threads >> x_bits_) +
                                             (lane >> x_bits_));
    if (x >= nx_ || y >= y_end_) return;
    std::int32_t z = z_begin_ + static_cast<std::int32_t>(plane) * walk_;
    std::int32_t const end = Kokkos::min(z + walk_, z_end_);
    for (; z < end; ++z) body(x, y, z);
  }

 private:
  static constexpr std::uint32_t threads = threads_of_tile;

  static std::uint32_t tiles(std::int64_t extent, std::int64_t tile) {
    return static_cast<std::uint32_t>((extent + tile - 1) / tile);
  }
  static std::int32_t bits_of(std::int32_t extent, std::int32_t most) {
    return std::min<std::int32_t>(
        static_cast<std::int32_t>(std::bit_width(static_cast<std::uint32_t>(extent - 1))), most);
  }

  std::int32_t nx_, y_begin_, y_end_, z_begin_, z_end_;
  std::int32_t walk_;    // largest number of sites per thread
  std::int32_t x_bits_;  // a tile is 2^x_bits_ sites wide
  std::uint32_t per_row_, per_plane_, planes_;
  QuickDivision by_row_, by_plane_;
};

}  // namespace cayspin::inline v0_2::detail
