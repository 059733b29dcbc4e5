// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/rows.hpp>
#include <cayspin/detail/sites_of_row.hpp>

#include <type_traits>

namespace cayspin::detail {

/// Neighbouring sites of a row, as many as Value has lanes.
template <class Value>
class Site : public SitesOfRow<Value, true, 1> {
  using Base = SitesOfRow<Value, true, 1>;
  using Base::row_, Base::x_;

 public:
  using Base::Base, Base::lanes;
  using typename Base::scalar_type;

  KOKKOS_FORCEINLINE_FUNCTION std::int32_t x() const { return x_; }
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t offset() const { return row_.offset + x_; }

  /// Are there lanes past the end of the row?
  KOKKOS_FORCEINLINE_FUNCTION bool is_partial() const { return row_.nx - x_ < lanes; }
  /// The lanes that are sites.
  KOKKOS_FORCEINLINE_FUNCTION auto inside() const {
    return lane_numbers<Value>() < Value(static_cast<scalar_type>(row_.nx - x_));
  }

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value load(SiteArray<Real, 1> const& array) const {
    return detail::load<Value>(array.data + offset());
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load(SiteArray<Real, 3> const& array) const {
    prefetch(array, offset() + row_.pitch);
    return load_at(array.data + row_.offset, array.stride);
  }
  /// The same, of an array whose neighbours are read too: the next row to come from memory is in
  /// the next plane.
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load_center(SiteArray<Real, 3> const& array) const {
    prefetch(array, offset() + row_.to_neighbor[1][1] + row_.pitch);
    return load_at(array.data + row_.offset, array.stride);
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load(RowInput<Real> const& row) const {
    if constexpr (lanes > 1) {
      for (int component = 0; component < 3; ++component)
        detail::prefetch(row.data + component * row.stride + x_ + row.ahead);
    }
    return load_at(row.data, row.stride);
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load_center(RowStencil<Real> const& rows) const {
    return load(static_cast<RowInput<Real> const&>(rows));
  }
  template <class Real, int Components>
  KOKKOS_FORCEINLINE_FUNCTION Value load(SiteArray<Real, Components> const& array,
                                         int component) const {
    return detail::load<Value>(array.data + component * array.stride + offset());
  }
  /// Loads from an array along x.
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value load_profile(Real const* profile) const {
    return detail::load<Value>(profile + x_);
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
    Real* const to = row.data + x_;
    if (row.streaming) {
      store_streaming(value.x, to);
      store_streaming(value.y, to + row.stride);
      store_streaming(value.z, to + 2 * row.stride);
    } else {
      detail::store(value.x, to);
      detail::store(value.y, to + row.stride);
      detail::store(value.z, to + 2 * row.stride);
    }
  }

  /// The value one site back (direction 0) or on (direction 1) along an axis; at an open end, and
  /// along an axis of extent 1, `center` itself.
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor(SiteArray<Real, 3> const& array,
                                                   Vec3<Value> const& center) const {
    Real const* const row = array.data + row_.offset;
    if constexpr (Axis > 0)
      return load_at(row + row_.to_neighbor[Axis - 1][Direction], array.stride);
    else
      return beside<Direction>(row, array.stride, center);
  }
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor(RowStencil<Real> const& rows,
                                                   Vec3<Value> const& center) const {
    if constexpr (Axis > 0)
      return load_at(rows.neighbor[Axis - 1][Direction], rows.stride);
    else
      return beside<Direction>(rows.data, rows.stride, center);
  }
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value neighbor(SiteArray<Real, 1> const& array,
                                             Value const& center) const {
    if constexpr (Axis > 0) {
      return detail::load<Value>(array.data + offset() + row_.to_neighbor[Axis - 1][Direction]);
    } else {
      Value const found = detail::load<Value>(array.data + offset() + (Direction == 0 ? -1 : 1));
      if (this->template holds_end<Direction>()) [[unlikely]]
        return select<Value>(this->template is_end<Direction>(),
                             this->template past_end<Direction>(array.data + row_.offset, center),
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

  template <int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> beside(Real const* row, std::ptrdiff_t stride,
                                                 Vec3<Value> const& center) const {
    Vec3<Value> found = load_at(row + (Direction == 0 ? -1 : 1), stride);
    if (this->template holds_end<Direction>()) [[unlikely]] {
      auto const end = this->template is_end<Direction>();
      found = {
          select<Value>(end, this->template past_end<Direction>(row, center.x), found.x),
          select<Value>(end, this->template past_end<Direction>(row + stride, center.y), found.y),
          select<Value>(end, this->template past_end<Direction>(row + 2 * stride, center.z),
                        found.z)};
    }
    return found;
  }

  /// The numbers at x of a row.
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load_at(Real const* row, std::ptrdiff_t stride) const {
    Real const* const from = row + x_;
    return {detail::load<Value>(from), detail::load<Value>(from + stride),
            detail::load<Value>(from + 2 * stride)};
  }
};

}  // namespace cayspin::detail
