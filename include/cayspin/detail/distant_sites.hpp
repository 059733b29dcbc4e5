// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/division_by.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/row_layout.hpp>
#include <cayspin/vec3.hpp>

#include <cstddef>
#include <cstdint>

// Loads of spins at a distance along x, y and z, up to the extents of the lattice.
namespace cayspin::inline v0_2::detail {

/// A field whose spins are read at a distance from a site. Past an open end the spins are zero.
template <class Real>
struct DistantSites {
  SiteArray<Real, 3> array;
  std::int32_t extent[3];  // of one replica
  bool periodic[3];
  DivisionBy replica;  // gives the number of a plane's replica
  std::ptrdiff_t pitch, plane;

  DistantSites(SiteArray<Real, 3> const& of, RowLayout const& layout)
      : array(of),
        extent{layout.nx, layout.ny, layout.replica_planes},
        periodic{layout.periodic[0], layout.periodic[1], layout.periodic[2]},
        replica(layout.has_replicas() ? DivisionBy(layout.replica_planes) : DivisionBy()),
        pitch(layout.pitch),
        plane(layout.plane) {}

  /// Loads spins at an offset, where all lanes must be sites of the lattice.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> inside(std::ptrdiff_t offset) const {
    return load_at<Value>(array.data + offset);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load_at(Real const* from) const {
    return {load<Value>(from), load<Value>(from + array.stride),
            load<Value>(from + 2 * array.stride)};
  }

  /// Returns the index of a plane within its replica.
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t plane_of_replica(std::int32_t z) const {
    return z - replica.quotient(z) * extent[2];
  }
  /// Returns a pointer to the first site of row (y + dy, z + dz), or null past an open end. |dy|
  /// and |dz| must be at most the extents along y and z.
  KOKKOS_FORCEINLINE_FUNCTION Real const* row(std::int32_t y, std::int32_t z, std::int32_t dy,
                                              std::int32_t dz) const {
    std::int32_t const in_replica = plane_of_replica(z), first = z - in_replica;
    y = wrapped(y + dy, 1);
    std::int32_t const there = wrapped(in_replica + dz, 2);
    if (y < 0 || there < 0) return nullptr;
    return array.data + (first + there) * plane + y * pitch;
  }

  /// Loads sites x, x + 1, ... of a row. Past its ends, a periodic row repeats, and an open row is
  /// zero. x may be outside the row by up to the row's length.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> along(Real const* row, std::int32_t x) const {
    constexpr std::int32_t lanes = lanes_of<Value>;
    std::int32_t const nx = extent[0];
    bool const is_before = x <= -lanes, is_after = x >= nx;
    if (!periodic[0] && (is_before || is_after)) return zero<Value>();
    x = is_before ? x + nx : is_after ? x - nx : x;
    if (x >= 0 && x + lanes <= nx) return load_at<Value>(row + x);
    if constexpr (lanes == 1)
      return load_at<Value>(row + x);
    else if (nx < lanes)
      return {lane_by_lane<Value>(row, x), lane_by_lane<Value>(row + array.stride, x),
              lane_by_lane<Value>(row + 2 * array.stride, x)};
    else
      return across_end<Value>(row, x);
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t wrapped(std::int32_t i, int axis) const {
    bool const before = i < 0, after = i >= extent[axis];
    if (!before && !after) return i;
    if (!periodic[axis]) return -1;
    return before ? i + extent[axis] : i - extent[axis];
  }

  /// Loads a pack that crosses an end of the row: lanes past the end come from the other end, or
  /// are zero at an open end. Memory outside the row is read, but its contents are ignored.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> across_end(Real const* row, std::int32_t x) const {
    using Scalar = scalar_t<Value>;
    bool const is_low = x < 0;
    auto const below =
        lane_numbers<Value>() < Value(static_cast<Scalar>(is_low ? -x : extent[0] - x));
    auto const here = load_at<Value>(row + x);
    auto const there = periodic[0] ? load_at<Value>(row + (is_low ? x + extent[0] : x - extent[0]))
                                   : zero<Value>();
    return is_low ? select<Value>(below, there, here) : select<Value>(below, here, there);
  }

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value lane_by_lane(Real const* row, std::int32_t x) const {
    using Scalar = scalar_t<Value>;
    auto const at = [&](std::int32_t lane) {
      // A lane two row lengths or more from the start of the row belongs to no site, so its value
      // is arbitrary.
      std::int32_t i = x + lane;
      i = wrapped(i < 2 * extent[0] ? i : extent[0] - 1, 0);
      return i < 0 ? Scalar(0) : static_cast<Scalar>(row[i]);
    };
    if constexpr (lanes_of<Value> == 1)
      return at(0);
    else
      return Value([&](auto lane) { return at(static_cast<std::int32_t>(lane())); });
  }
};

}  // namespace cayspin::inline v0_2::detail
