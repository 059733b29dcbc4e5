// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/every_other.hpp>
#include <cayspin/detail/rows.hpp>
#include <cayspin/detail/sites_of_row.hpp>

namespace cayspin::inline v0_2::detail {

/// Sites of one colour of a checkerboard, as many as Value has lanes, two apart in one row: x, x +
/// 2, ... In their row, loads reach from the neighbour before the first lane to the neighbour after
/// the last one, so that no further sites of this colour are read.
template <class Value, bool AtEdge>
class ColourSite : public SitesOfRow<Value, AtEdge, 2> {
  using Base = SitesOfRow<Value, AtEdge, 2>;
  using Base::row_, Base::x_;

 public:
  using typename Base::scalar_type;
  using mask_type = typename ValueTraits<Value>::mask;
  using Base::Base, Base::lanes;

  /// Deleted: the lanes are two apart, so x plus the lane's number would be wrong.
  std::int32_t x() const = delete;

  /// Returns the mask of lanes that are sites.
  KOKKOS_FORCEINLINE_FUNCTION mask_type inside() const {
    return lane_numbers<Value>() < Value(static_cast<scalar_type>(count()));
  }

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value load(SiteArray<Real, 1> const& array) const {
    check_precision<Value, Real>();
    return at(array.data + row_.offset);
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> load(SiteArray<Real, 3> const& array) const {
    check_precision<Value, Real>();
    return vector_at(array.data + row_.offset, array.stride);
  }
  template <class Real, int Components>
  KOKKOS_FORCEINLINE_FUNCTION Value load(SiteArray<Real, Components> const& array,
                                         int component) const {
    check_precision<Value, Real>();
    return at(array.data + component * array.stride + row_.offset);
  }

  /// Writes these sites and leaves the sites between them unchanged.
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void store(Vec3<Value> const& value,
                                         SiteArray<Real, 3> const& array) const {
    Real* const to = array.data + row_.offset + x_;
    store_every_other(value.x, to, count());
    store_every_other(value.y, to + array.stride, count());
    store_every_other(value.z, to + 2 * array.stride, count());
  }

  /// For Stencil, which asks a site for its Place (see Site::Place). ColourSite itself does not use
  /// it.
  struct Place {
    std::ptrdiff_t stride;
  };
  template <class Spins>
  KOKKOS_FORCEINLINE_FUNCTION Place place(Spins const& spins) const {
    return {spins.stride};
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION void load_row(SiteArray<Real, 3> const& array, Place const&,
                                            Vec3<Value>& center, Vec3<Value> (&found)[2]) const {
    Real const* const row = array.data + row_.offset;
    for (int component = 0; component < 3; ++component)
      prefetch(row + component * array.stride + x_ + row_.to_neighbor[1][1] + row_.pitch);
    center = load(array);
    found[0] = vector_beside<0>(row, array.stride, center);
    found[1] = vector_beside<1>(row, array.stride, center);
  }
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor(SiteArray<Real, 3> const& array,
                                                   Place const&) const {
    return vector_at(array.data + row_.offset + row_.to_neighbor[Axis - 1][Direction],
                     array.stride);
  }
  template <int Axis, int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value neighbor(SiteArray<Real, 1> const& array,
                                             Value const& center) const {
    Real const* const row = array.data + row_.offset;
    if constexpr (Axis > 0)
      return at(row + row_.to_neighbor[Axis - 1][Direction]);
    else
      return beside<Direction>(row, center);
  }

 private:
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t count() const {
    if constexpr (!AtEdge) return lanes;
    return Kokkos::min<std::int32_t>(lanes, (to_last() + 2) / 2);
  }
  KOKKOS_FORCEINLINE_FUNCTION std::int32_t to_last() const {
    return row_.nx - 1 - static_cast<std::int32_t>(x_);
  }
  /// Returns true if two whole packs from the first lane on stay within the row's memory.
  KOKKOS_FORCEINLINE_FUNCTION bool has_room() const { return x_ + 2 * lanes <= row_.pitch; }

  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value at(Real const* row) const {
    if constexpr (AtEdge) {
      if (!has_room()) return load_every_other_of<Value>(row + x_, 0, to_last());
    }
    return load_every_other<0, Value>(row + x_);
  }
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> vector_at(Real const* row, std::ptrdiff_t stride) const {
    return {at(row), at(row + stride), at(row + 2 * stride)};
  }

  template <int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> vector_beside(Real const* row, std::ptrdiff_t stride,
                                                        Vec3<Value> const& center) const {
    return {beside<Direction>(row, center.x), beside<Direction>(row + stride, center.y),
            beside<Direction>(row + 2 * stride, center.z)};
  }
  template <int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value beside(Real const* row, Value const& center) const {
    if constexpr (AtEdge) {
      bool const whole = has_room() && (Direction == 1 || x_ > 0);
      Value found = whole ? whole_beside<Direction>(row)
                          : load_every_other_of<Value>(row + x_ + (Direction == 0 ? -1 : 1),
                                                       Direction == 0 && x_ == 0 ? 1 : 0,
                                                       to_last() + (Direction == 0 ? 1 : -1));
      if (this->template holds_end<Direction>())
        found = select<Value>(this->template is_end<Direction>(),
                              this->template beyond<Direction>(row, center), found);
      return found;
    } else {
      return whole_beside<Direction>(row);
    }
  }
  template <int Direction, class Real>
  KOKKOS_FORCEINLINE_FUNCTION Value whole_beside(Real const* row) const {
    if constexpr (Direction == 0)
      return load_every_other<0, Value>(row + x_ - 1);
    else
      return load_every_other<1, Value>(row + x_);
  }
};

}  // namespace cayspin::inline v0_2::detail
