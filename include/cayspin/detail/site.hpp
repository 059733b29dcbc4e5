// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/row_layout.hpp>
#include <cayspin/detail/rows.hpp>
#include <cayspin/vec3.hpp>

#include <type_traits>

namespace cayspin::detail {

/// A row along x and the way to its neighbour rows; an open end leads back to the row itself.
struct Row {
  std::ptrdiff_t offset;
  std::ptrdiff_t to_neighbor[2][2];  // [axis - 1][previous, next], relative to `offset`
  std::int32_t nx, y, z;
  bool periodic_x;
  std::ptrdiff_t pitch;

  KOKKOS_FORCEINLINE_FUNCTION Row(RowLayout const& layout, std::int64_t row)
      : Row(layout, static_cast<std::int32_t>(row % layout.ny),
            static_cast<std::int32_t>(row / layout.ny)) {}
  KOKKOS_FORCEINLINE_FUNCTION Row(RowLayout const& layout, std::int32_t at_y, std::int32_t at_z)
      : offset((std::int64_t(at_z) * layout.ny + at_y) * layout.pitch),
        nx(layout.nx),
        y(at_y),
        z(at_z),
        periodic_x(layout.periodic[0]),
        pitch(layout.pitch) {
    step(0, y, layout.ny, layout.pitch, layout.periodic[1]);
    step(1, z, layout.nz, layout.pitch * layout.ny, layout.periodic[2]);
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION void step(int which, std::int32_t index, std::int32_t extent,
                                        std::ptrdiff_t stride, bool periodic) {
    std::ptrdiff_t const around = periodic ? (extent - 1) * stride : 0;
    to_neighbor[which][0] = index > 0 ? -stride : around;
    to_neighbor[which][1] = index + 1 < extent ? stride : -around;
  }
};

/// The sites that one iteration works on: as many as Value has lanes, starting at x, in one row.
/// AtEdge: they may hold the first or the last site of the row.
template <class Value, bool AtEdge>
class Site {
 public:
  using value_type = Value;
  using scalar_type = scalar_t<Value>;
  static constexpr int lanes = lanes_of<Value>;

  KOKKOS_FORCEINLINE_FUNCTION Site(Row const& row, std::int32_t x) : row_(row), x_(x) {}

  KOKKOS_FORCEINLINE_FUNCTION Row const& row() const { return row_; }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t x() const { return x_; }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t y() const { return row_.y; }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t z() const { return row_.z; }
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t offset() const { return row_.offset + x_; }

  /// 1 on lanes that are sites, 0 on lanes past the end of the row.
  KOKKOS_FORCEINLINE_FUNCTION Value inside() const {
    if constexpr (!AtEdge || lanes == 1) {
      return Value(scalar_type(1));
    } else {
      return select<Value>(lane_numbers<Value>() < Value(static_cast<scalar_type>(row_.nx - x_)),
                           Value(scalar_type(1)), Value(scalar_type(0)));
    }
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
  /// the plane behind.
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
  /// Of an array along x.
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

  /// `found`, a neighbour along x, but `missing` on the lane at an open end.
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> unless_past_end(Vec3<Value> const& found,
                                                          Vec3<Value> const& missing) const {
    if constexpr (AtEdge) {
      if (!row_.periodic_x && holds_end<Direction>()) {
        auto const end = is_end<Direction>();
        return {select<Value>(end, missing.x, found.x), select<Value>(end, missing.y, found.y),
                select<Value>(end, missing.z, found.z)};
      }
    }
    return found;
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
      if constexpr (AtEdge) {
        if (holds_end<Direction>())
          return select<Value>(is_end<Direction>(),
                               past_end<Direction>(array.data + row_.offset, center), found);
      }
      return found;
    }
  }

  /// The same with `missing` at an open end, and along an axis of extent 1.
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor_or(SiteArray<Real, 3> const& array,
                                                      Vec3<Value> const& missing) const {
    if constexpr (Axis > 0) {
      if (row_.to_neighbor[Axis - 1][Direction] == 0) return missing;
    }
    return neighbor<Axis, Direction>(array, missing);
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

  /// The lane at the end of the row, without a neighbour beside it; it may be none of the lanes.
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t end_lane() const {
    return Direction == 0 ? -x_ : row_.nx - 1 - x_;
  }
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION bool holds_end() const {
    return end_lane<Direction>() >= 0 && end_lane<Direction>() < lanes;
  }
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION auto is_end() const {
    return lane_numbers<Value>() == Value(static_cast<scalar_type>(end_lane<Direction>()));
  }
  /// What stands for the neighbour past the end of a row: the other end, or `center`.
  template <int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value past_end(Real const* row, Value const& center) const {
    return row_.periodic_x ? Value(scalar_type(row[Direction == 0 ? row_.nx - 1 : 0])) : center;
  }

  template <int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> beside(Real const* row, std::ptrdiff_t stride,
                                                 Vec3<Value> const& center) const {
    Vec3<Value> found = load_at(row + (Direction == 0 ? -1 : 1), stride);
    if constexpr (AtEdge) {
      if (holds_end<Direction>()) {
        auto const end = is_end<Direction>();
        found = {select<Value>(end, past_end<Direction>(row, center.x), found.x),
                 select<Value>(end, past_end<Direction>(row + stride, center.y), found.y),
                 select<Value>(end, past_end<Direction>(row + 2 * stride, center.z), found.z)};
      }
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

  Row const& row_;
  std::int32_t x_;
};

}  // namespace cayspin::detail
