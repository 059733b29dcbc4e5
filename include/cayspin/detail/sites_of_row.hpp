// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>
#include <cayspin/row_layout.hpp>
#include <cayspin/vec3.hpp>

#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// A row along x and the offsets of its neighbour rows; at an open end the offset is 0.
struct Row {
  std::ptrdiff_t offset;
  std::ptrdiff_t to_neighbor[2][2];  // [axis - 1][previous, next], relative to `offset`
  std::int32_t nx, y, z;
  bool periodic_x;
  std::ptrdiff_t pitch;

  KOKKOS_FORCEINLINE_FUNCTION Row(RowLayout const& layout, std::int32_t at_y, std::int32_t at_z)
      : offset(layout.row_offset(at_y, at_z)),
        nx(layout.nx),
        y(at_y),
        z(at_z),
        periodic_x(layout.periodic[0]),
        pitch(layout.pitch) {
    step(0, y, layout.ny, layout.pitch, layout.periodic[1]);
    step(1, layout.plane_of_replica(z), layout.replica_planes, layout.plane, layout.periodic[2]);
  }

  /// Returns true if there is a neighbour row along y or z. (Along x, it depends on the site.)
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION bool has_neighbor() const {
    return to_neighbor[Axis - 1][Direction] != 0;
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION void step(int which, std::int32_t index, std::int32_t extent,
                                        std::ptrdiff_t stride, bool periodic) {
    std::ptrdiff_t const around = periodic ? (extent - 1) * stride : 0;
    to_neighbor[which][0] = index > 0 ? -stride : around;
    to_neighbor[which][1] = index + 1 < extent ? stride : -around;
  }
};

/// The sites of one iteration, as many as Value has lanes: x, x + Spacing, ... in one row. If
/// AtEdge is true, they may include the first or the last site of the row.
template <class Value, bool AtEdge, int Spacing>
class SitesOfRow {
 public:
  using value_type = Value;
  using scalar_type = scalar_t<Value>;
  static constexpr int lanes = lanes_of<Value>;
  static constexpr bool is_between_ends = !AtEdge;

  KOKKOS_FORCEINLINE_FUNCTION SitesOfRow(Row const& row, std::ptrdiff_t x) : row_(row), x_(x) {}

  KOKKOS_FORCEINLINE_FUNCTION Row const& row() const { return row_; }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t y() const { return row_.y; }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t z() const { return row_.z; }

  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION bool has_neighbor() const {
    return row_.template has_neighbor<Axis, Direction>();
  }
  /// Returns true if all these sites have neighbours on both sides along `Axis`.
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION bool is_between() const {
    if constexpr (Axis > 0)
      return has_neighbor<Axis, 0>() && has_neighbor<Axis, 1>();
    else if constexpr (AtEdge)
      return row_.periodic_x || !(holds_end<0>() || holds_end<1>());
    else
      return true;
  }
  /// Returns `found`, the neighbours along x, but `missing` in a lane at an open end.
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> unless_past_end(Vec3<Value> const& found,
                                                          Vec3<Value> const& missing) const {
    if constexpr (AtEdge) {
      if (!row_.periodic_x && holds_end<Direction>()) [[unlikely]]
        return select<Value>(is_end<Direction>(), missing, found);
    }
    return found;
  }

 protected:
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION bool holds_end() const {
    std::ptrdiff_t const way = to_end<Direction>();
    if constexpr (Spacing == 1) return Direction == 0 ? way == 0 : way < lanes;
    return way >= 0 && way < Spacing * lanes && way % Spacing == 0;
  }
  /// Returns the mask of the lane at the end of the row. Call it only if holds_end<Direction>() is
  /// true.
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION auto is_end() const {
    return lane_numbers<Value>() == Value(static_cast<scalar_type>(to_end<Direction>() / Spacing));
  }
  /// Returns the neighbour past the end of a row: the site at the other end, or `center` at an open
  /// end.
  template <int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value beyond(Real const* row, Value const& center) const {
    return row_.periodic_x ? Value(scalar_type(row[Direction == 0 ? row_.nx - 1 : 0])) : center;
  }

  Row const& row_;
  std::ptrdiff_t x_;

 private:
  /// Returns the offset from the first lane to the end of the row.
  template <int Direction>
  KOKKOS_FORCEINLINE_FUNCTION std::ptrdiff_t to_end() const {
    return Direction == 0 ? -x_ : row_.nx - 1 - x_;
  }
};

}  // namespace cayspin::inline v0_2::detail
