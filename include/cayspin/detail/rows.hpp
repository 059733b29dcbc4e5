// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/row_layout.hpp>
#include <cayspin/vec3.hpp>

#include <cstddef>
#include <cstdint>

// Rows of spins, in a field or in the buffers of a sweep, for a Runge-Kutta stage.
namespace cayspin::inline v0_2::detail {

/// A row of vectors: component c at site x is data[c * stride + x].
template <class Real>
struct RowInput {
  Real const* data = nullptr;
  std::ptrdiff_t stride = 0;
};

/// A row and its neighbours along y and z. A missing neighbour is the row itself.
template <class Real>
struct RowStencil : RowInput<Real> {
  Real const* neighbor[2][2] = {};  // [axis - 1][previous, next]
};

template <class Real>
struct RowOutput {
  Real* data = nullptr;
  std::ptrdiff_t stride = 0;
  bool streaming = false;
};

/// Indices along an axis: of rows along y, or of planes along z. On a periodic axis they repeat
/// with its extent.
struct Axis {
  std::int32_t extent = 1;
  bool wraps = false;

  Axis() = default;
  KOKKOS_FUNCTION Axis(RowLayout const& layout, int axis)
      : extent(axis == 1 ? layout.ny : layout.nz), wraps(layout.periodic[axis] && extent > 1) {}

  /// Return the neighbour of i, which on a periodic axis may be -1 or `extent`, or i itself at an
  /// open end.
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t previous(std::int32_t i) const {
    return i > 0 || wraps ? i - 1 : i;
  }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t next(std::int32_t i) const {
    return i + 1 < extent || wraps ? i + 1 : i;
  }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t wrapped(std::int32_t i) const {
    if (0 <= i && i < extent) return i;
    std::int32_t const rest = i % extent;
    return rest < 0 ? rest + extent : rest;
  }
  /// Returns true at an open end: no index below i then has a neighbour at i or above.
  KOKKOS_FORCEINLINE_FUNCTION bool is_cut(std::int32_t i) const {
    return !wraps && (i <= 0 || i >= extent);
  }
};

/// Indices of planes along z, which end or repeat within each replica.
struct PlaneAxis : Axis {
  std::int32_t replica = 1;     // planes per replica
  bool wraps_replicas = false;  // true if there are several replicas, each periodic

  PlaneAxis() = default;
  KOKKOS_FUNCTION explicit PlaneAxis(RowLayout const& layout)
      : Axis(layout, 2), replica(layout.replica_planes) {
    if (replica == extent) return;
    wraps = false;
    wraps_replicas = layout.periodic[2];
  }

  KOKKOS_FORCEINLINE_FUNCTION std::int32_t previous(std::int32_t i) const {
    if (replica == extent) return Axis::previous(i);
    if (i % replica != 0) return i - 1;
    return wraps_replicas ? i + replica - 1 : i;
  }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t next(std::int32_t i) const {
    if (replica == extent) return Axis::next(i);
    if ((i + 1) % replica != 0) return i + 1;
    return wraps_replicas ? i + 1 - replica : i;
  }
  KOKKOS_FORCEINLINE_FUNCTION bool is_cut(std::int32_t i) const {
    return Axis::is_cut(i) || (replica != extent && i % replica == 0);
  }
};

/// The rows of one plane, in up to three pieces of memory. Rows first .. last - 1 start at
/// `middle`, rows from `last` on start at `high`, and rows before `first` end at `low`.
template <class Real>
struct PlaneRows {
  Real *low = nullptr, *middle = nullptr, *high = nullptr;
  std::int32_t first = 0, last = 0;
  std::ptrdiff_t pitch = 0, stride = 0;

  KOKKOS_FORCEINLINE_FUNCTION Real* row(std::int32_t y) const {
    if (y < first) return low + (y - first) * pitch;
    return y < last ? middle + (y - first) * pitch : high + (y - last) * pitch;
  }
  KOKKOS_FORCEINLINE_FUNCTION RowInput<Real> input(std::int32_t y) const {
    return {row(y), stride};
  }
  KOKKOS_FORCEINLINE_FUNCTION RowOutput<Real> output(std::int32_t y, bool streaming) const {
    return {row(y), stride, streaming};
  }
};

/// Returns plane z of a field. `low` and `high` continue its rows periodically.
template <class Real>
CAYSPIN_DETAIL_NOINLINE KOKKOS_FUNCTION PlaneRows<Real> plane_rows(SiteArray<Real, 3> const& array,
                                                                   RowLayout const& layout,
                                                                   std::int32_t z) {
  Real* const plane = array.data + layout.row_offset(0, z);
  return {plane + layout.ny * layout.pitch, plane, plane, 0, layout.ny, layout.pitch, array.stride};
}

}  // namespace cayspin::inline v0_2::detail
