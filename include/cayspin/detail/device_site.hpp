// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/division_by.hpp>
#include <cayspin/detail/memory.hpp>
#include <cayspin/row_layout.hpp>
#include <cayspin/vec3.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <type_traits>

// Addresses of the sites of a device thread. Most of the integer work of a device kernel is
// addressing, so it is kept short, with 32-bit integers where they suffice: one offset for each
// site of the stencil, found without a branch at the ends of the lattice, and one multiply-add for
// each component.
namespace cayspin::inline v0_2::detail {

/// Pointers to the three components of a field.
template <class Real>
struct ComponentPointers {
  using value_type = Real;
  static constexpr int components = 3;
  Real* component[3] = {};

  ComponentPointers() = default;
  KOKKOS_FUNCTION explicit ComponentPointers(SiteArray<Real, 3> const& array)
      : component{array.data, array.data + array.stride, array.data + 2 * array.stride} {}
};

/// The RowLayout of device kernels. Index: an integer type that is large enough for offsets within
/// one component.
template <class Index>
struct DeviceLayout {
  std::int32_t last[3];  // last index along each axis, in a replica
  Index step[3];         // offset from a site to the next one along each axis
  Index wrap[3];         // shifts a step past an end to the other end, or back to the site
  bool periodic_x;
  DivisionBy replica;  // gives the number of a plane's replica

  explicit DeviceLayout(RowLayout const& layout)
      : last{layout.nx - 1, layout.ny - 1, layout.replica_planes - 1},
        step{1, static_cast<Index>(layout.pitch), static_cast<Index>(layout.plane)},
        periodic_x(layout.periodic[0]),
        replica(layout.has_replicas() ? DivisionBy(layout.replica_planes) : DivisionBy()) {
    for (int axis = 0; axis < 3; ++axis)
      wrap[axis] = layout.periodic[axis] ? step[axis] * (last[axis] + 1) : step[axis];
  }

  /// Returns the index of a plane within its replica.
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t plane_of_replica(std::int32_t z) const {
    return z - replica.quotient(z) * (last[2] + 1);
  }

  /// Returns true if Index is large enough for the numbers of one component plus one plane, and for
  /// all threads.
  static bool reaches(RowLayout const& layout, std::int64_t threads) {
    std::int64_t const numbers = (layout.nz + std::int64_t(1)) * layout.plane;
    return std::max(numbers, threads) <= std::numeric_limits<Index>::max();
  }
};

/// A site of a device thread, with the members of Site that device kernels use.
template <class Value, class Index>
class DeviceSite {
 public:
  using value_type = Value;
  using scalar_type = Value;
  static constexpr int lanes = 1;

  KOKKOS_FORCEINLINE_FUNCTION DeviceSite(DeviceLayout<Index> const& layout, std::int32_t x,
                                         std::int32_t y, std::int32_t z)
      : layout_(layout),
        at_{x, y, z},
        offset_(static_cast<Index>(z) * layout.step[2] + static_cast<Index>(y) * layout.step[1] +
                static_cast<Index>(x)) {}

  KOKKOS_FORCEINLINE_FUNCTION std::int32_t x() const { return at_[0]; }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t y() const { return at_[1]; }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t z() const { return at_[2]; }
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t offset() const { return offset_; }
  KOKKOS_FORCEINLINE_FUNCTION bool is_partial() const { return false; }
  KOKKOS_FORCEINLINE_FUNCTION bool inside() const { return true; }

  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION bool is_end() const {
    std::int32_t const at = Axis == 2 ? layout_.plane_of_replica(at_[2]) : at_[Axis];
    return at == (Direction == 0 ? 0 : layout_.last[Axis]);
  }
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION bool has_neighbor() const {
    return !is_end<Axis, Direction>() || layout_.wrap[Axis] != layout_.step[Axis];
  }

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value load(SiteArray<Real, 1> const& array) const {
    check_precision<Value, Real>();
    return detail::load<Value>(array.data + offset_);
  }
  template <class Array>
    requires(Array::components == 3)
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load(Array const& array) const {
    check_precision<Value, typename Array::value_type>();
    return load_at(array, offset_);
  }
  template <class Real, int Components>
  KOKKOS_FORCEINLINE_FUNCTION Value load(SiteArray<Real, Components> const& array,
                                         int component) const {
    check_precision<Value, Real>();
    return detail::load<Value>(array.data + component * array.stride + offset_);
  }

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void store(Value const& value,
                                         SiteArray<Real, 1> const& array) const {
    detail::store(value, array.data + offset_);
  }
  template <class Array>
  KOKKOS_FORCEINLINE_FUNCTION void store(Vec3<Value> const& value, Array const& array) const {
    detail::store(value.x, component<0>(array) + offset_);
    detail::store(value.y, component<1>(array) + offset_);
    detail::store(value.z, component<2>(array) + offset_);
  }

  struct Place {};
  template <class Spins>
  KOKKOS_FORCEINLINE_FUNCTION Place place(Spins const&) const {
    return {};
  }

  template <class Array>
  KOKKOS_FORCEINLINE_FUNCTION void load_row(Array const& array, Place const& place,
                                            Vec3<Value>& center, Vec3<Value> (&beside)[2]) const {
    center = load(array);
    beside[0] = neighbor<0, 0>(array, place);
    beside[1] = neighbor<0, 1>(array, place);
  }
  template <int Axis, int Direction, class Array>
    requires(Array::components == 3)
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor(Array const& array, Place const&) const {
    return load_at(array, beside<Axis, Direction>());
  }
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value neighbor(SiteArray<Real, 1> const& array, Value const&) const {
    return detail::load<Value>(array.data + beside<Axis, Direction>());
  }
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> unless_past_end(Vec3<Value> const& found,
                                                          Vec3<Value> const& missing) const {
    bool const past = !layout_.periodic_x && is_end<0, Direction>();
    return past ? missing : found;
  }

 private:
  /// Returns the offset of the neighbour, or of the site itself at an open end.
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION Index beside() const {
    Index const step = Axis == 0 ? 1 : layout_.step[Axis];
    Index const wrap = is_end<Axis, Direction>() ? layout_.wrap[Axis] : 0;
    return Direction == 0 ? offset_ - step + wrap : offset_ + step - wrap;
  }

  template <int Component, class Real>
  KOKKOS_FORCEINLINE_FUNCTION static Real* component(ComponentPointers<Real> const& array) {
    return array.component[Component];
  }
  template <int Component, class Real>
  KOKKOS_FORCEINLINE_FUNCTION static Real* component(SiteArray<Real, 3> const& array) {
    return array.data + Component * array.stride;
  }
  template <class Array>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> load_at(Array const& array, Index offset) {
    return {detail::load<Value>(component<0>(array) + offset),
            detail::load<Value>(component<1>(array) + offset),
            detail::load<Value>(component<2>(array) + offset)};
  }

  DeviceLayout<Index> const& layout_;
  std::int32_t at_[3];
  Index offset_;
};

}  // namespace cayspin::inline v0_2::detail
