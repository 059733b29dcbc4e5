// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/rows.hpp>
#include <cayspin/detail/sites_of_row.hpp>

#include <type_traits>

namespace cayspin::inline v0_2::detail {

/// Adjacent sites of a row, as many as Value has lanes.
template <class Value, bool AtEdge = true>
class Site : public SitesOfRow<Value, AtEdge, 1> {
  using Base = SitesOfRow<Value, AtEdge, 1>;
  using Base::row_, Base::x_;

 public:
  using Base::Base, Base::lanes;
  using typename Base::scalar_type;

  KOKKOS_FORCEINLINE_FUNCTION std::int32_t x() const { return static_cast<std::int32_t>(x_); }
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t offset() const { return row_.offset + x_; }

  /// Returns true if there are lanes past the end of the row.
  KOKKOS_FORCEINLINE_FUNCTION bool is_partial() const { return row_.nx - x_ < lanes; }
  /// Returns the mask of lanes that are sites.
  KOKKOS_FORCEINLINE_FUNCTION auto inside() const {
    return lane_numbers<Value>() < Value(static_cast<scalar_type>(row_.nx - x_));
  }

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value load(SiteArray<Real, 1> const& array) const {
    check_precision<Value, Real>();
    return detail::load<Value>(array.data + offset());
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load(SiteArray<Real, 3> const& array) const {
    check_precision<Value, Real>();
    prefetch(array, offset() + row_.pitch);
    return load_at(array.data + row_.offset, array.stride);
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load(RowInput<Real> const& row) const {
    return load_at(row.data, row.stride);
  }
  template <class Real, int Components>
  KOKKOS_FORCEINLINE_FUNCTION Value load(SiteArray<Real, Components> const& array,
                                         int component) const {
    check_precision<Value, Real>();
    return detail::load<Value>(array.data + component * array.stride + offset());
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void store(Value const& value,
                                         OutputArray<Real, 1> const& array) const {
    detail::store(value, array.data + offset());
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void store(Vec3<Value> const& value,
                                         OutputArray<Real, 3> const& array) const {
    store(value, RowOutput<Real>{array.data + row_.offset, array.stride, array.streaming});
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void store(Vec3<Value> const& value,
                                         RowOutput<Real> const& row) const {
    Real* const to = opaque(row.data + x_);
    if (row.streaming) [[unlikely]] {
      store_streaming(value.x, to);
      store_streaming(value.y, to + row.stride);
      store_streaming(value.z, to + 2 * row.stride);
    } else {
      detail::store(value.x, to);
      detail::store(value.y, to + row.stride);
      detail::store(value.z, to + 2 * row.stride);
    }
  }

  /// Offsets of the three components of these sites from the start of their row. One Place serves
  /// all rows of a stencil, since their components have equal strides.
  struct Place {
    std::ptrdiff_t x, y, z;
  };
  template <class Spins>
  KOKKOS_FORCEINLINE_FUNCTION Place place(Spins const& spins) const {
    std::ptrdiff_t const y = opaque(x_ + spins.stride);
    return {x_, y, opaque(y + spins.stride)};
  }

  /// Loads the spins and their neighbours along x; at an open end the neighbour is the spin itself.
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void load_row(SiteArray<Real, 3> const& array, Place const& place,
                                            Vec3<Value>& center, Vec3<Value> (&beside)[2]) const {
    prefetch(array, offset() + row_.to_neighbor[1][1] + row_.pitch);
    load_row(array.data + row_.offset, place, center, beside);
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void load_row(RowStencil<Real> const& rows, Place const& place,
                                            Vec3<Value>& center, Vec3<Value> (&beside)[2]) const {
    load_row(rows.data, place, center, beside);
  }

  /// Loads the neighbour before (direction 0) or after (direction 1) along y or z; at an open end,
  /// and along an axis of extent 1, the spin itself.
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor(SiteArray<Real, 3> const& array,
                                                   Place const& place) const {
    return load_from(array.data + row_.offset + row_.to_neighbor[Axis - 1][Direction], place);
  }
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor(RowStencil<Real> const& rows,
                                                   Place const& place) const {
    return load_from(rows.neighbor[Axis - 1][Direction], place);
  }
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value neighbor(SiteArray<Real, 1> const& array,
                                             Value const& center) const {
    if constexpr (Axis > 0) {
      return detail::load<Value>(array.data + offset() + row_.to_neighbor[Axis - 1][Direction]);
    } else {
      Value const found = detail::load<Value>(array.data + offset() + (Direction == 0 ? -1 : 1));
      if (AtEdge && this->template holds_end<Direction>())
        return select<Value>(this->template is_end<Direction>(),
                             this->template beyond<Direction>(array.data + row_.offset, center),
                             found);
      return found;
    }
  }

 private:
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION static void prefetch(SiteArray<Real, 3> const& array,
                                                   std::ptrdiff_t offset) {
    if constexpr (lanes > 1) {
      for (int component = 0; component < 3; ++component)
        detail::prefetch(array.data + component * array.stride + offset);
    }
  }

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> load_from(Real const* row, Place const& place) {
    return {detail::load<Value>(row + place.x), detail::load<Value>(row + place.y),
            detail::load<Value>(row + place.z)};
  }

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void load_row(Real const* row, Place const& place,
                                            Vec3<Value>& center, Vec3<Value> (&beside)[2]) const {
    center = {detail::load<Value>(row + place.x), detail::load<Value>(row + place.y),
              detail::load<Value>(row + place.z)};
    beside[0] = {detail::load<Value>(row + place.x - 1), detail::load<Value>(row + place.y - 1),
                 detail::load<Value>(row + place.z - 1)};
    beside[1] = {detail::load<Value>(row + place.x + 1), detail::load<Value>(row + place.y + 1),
                 detail::load<Value>(row + place.z + 1)};
    if (!AtEdge || (x_ > 0 && row_.nx - x_ > lanes)) [[likely]]
      return;
    std::ptrdiff_t const strides[2] = {place.y - place.x, place.z - place.x};
    if (this->template holds_end<0>())
      beside[0] =
          select<Value>(this->template is_end<0>(), past_end<0>(row, strides, center), beside[0]);
    if (this->template holds_end<1>())
      beside[1] =
          select<Value>(this->template is_end<1>(), past_end<1>(row, strides, center), beside[1]);
  }

  /// Loads the neighbours past the end of a row: those at the other end, or at an open end the
  /// spins themselves.
  template <int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> past_end(Real const* row,
                                                   std::ptrdiff_t const (&strides)[2],
                                                   Vec3<Value> const& center) const {
    if (!row_.periodic_x) return center;
    Real const* const end = row + (Direction == 0 ? row_.nx - 1 : 0);
    return {Value(scalar_type(end[0])), Value(scalar_type(end[strides[0]])),
            Value(scalar_type(end[strides[1]]))};
  }

  /// Loads the vectors of these sites from a row.
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load_at(Real const* row, std::ptrdiff_t stride) const {
    Real const* const from = opaque(row + x_);
    return {detail::load<Value>(from), detail::load<Value>(from + stride),
            detail::load<Value>(from + 2 * stride)};
  }
};

}  // namespace cayspin::inline v0_2::detail
