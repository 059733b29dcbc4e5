// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/site.hpp>

namespace cayspin::inline v0_2 {

/// The argument of field terms and generators: the spin of a site and its neighbours along the axes
/// of the lattice. On the host a value is a pack: one number for each of several sites. The
/// functions cayspin::next<0>(stencil) and cayspin::previous<0>(stencil) do what the members do,
/// and need no `template` keyword in generic code.
template <class Site, class Real, class Spins = SiteArray<Real, 3>>
class Stencil {
 public:
  using value_type = typename Site::value_type;
  using vector_type = Vec3<value_type>;

  KOKKOS_FORCEINLINE_FUNCTION Stencil(Site const& site, Spins const& spins)
      : site_(site), spins_(spins), place_(site.place(spins)) {
    site.load_row(spins, place_, center_, beside_);
  }

  KOKKOS_FORCEINLINE_FUNCTION vector_type const& center() const { return center_; }

  /// Returns the neighbour at index - 1, or the spin itself if there is none.
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous() const {
    return neighbor<Axis, 0>();
  }
  /// Returns the neighbour at index + 1, or the spin itself if there is none.
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next() const {
    return neighbor<Axis, 1>();
  }

  /// Return the neighbour, or `missing` if there is none.
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous(vector_type const& missing) const {
    return neighbor_or<Axis, 0>(missing);
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next(vector_type const& missing) const {
    return neighbor_or<Axis, 1>(missing);
  }

  /// Returns true if all sites of the pack have neighbours on both sides along an axis.
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION bool is_between() const
    requires requires(Site const& site) { site.template is_between<Axis>(); }
  {
    return site_.template is_between<Axis>();
  }

  /// Returns the site, which loads further per-site arrays (SiteField::array).
  KOKKOS_FORCEINLINE_FUNCTION Site const& site() const { return site_; }

 private:
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION vector_type neighbor() const {
    if constexpr (Axis == 0)
      return beside_[Direction];
    else
      return site_.template neighbor<Axis, Direction>(spins_, place_);
  }
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION vector_type neighbor_or(vector_type const& missing) const {
    if constexpr (Axis == 0)
      return site_.template unless_past_end<Direction>(beside_[Direction], missing);
    else
      return site_.template has_neighbor<Axis, Direction>() ? neighbor<Axis, Direction>() : missing;
  }

  Site const& site_;
  Spins const& spins_;
  typename Site::Place place_;
  vector_type center_;
  // Neighbours along x. Their loads need a branch at the ends of rows, and are done once for all
  // terms; if no term uses them, they cost nothing.
  vector_type beside_[2];
};

/// Returns the neighbour at index + 1 along an axis (0, 1, 2 for x, y, z); the spin itself, or
/// `missing`, if there is none.
template <int Axis, class AnyStencil>
KOKKOS_FORCEINLINE_FUNCTION auto next(AnyStencil const& stencil) {
  return stencil.template next<Axis>();
}
template <int Axis, class AnyStencil>
KOKKOS_FORCEINLINE_FUNCTION auto next(AnyStencil const& stencil,
                                      typename AnyStencil::vector_type const& missing) {
  return stencil.template next<Axis>(missing);
}

/// Returns the neighbour at index - 1 along an axis; the spin itself, or `missing`, if there is
/// none.
template <int Axis, class AnyStencil>
KOKKOS_FORCEINLINE_FUNCTION auto previous(AnyStencil const& stencil) {
  return stencil.template previous<Axis>();
}
template <int Axis, class AnyStencil>
KOKKOS_FORCEINLINE_FUNCTION auto previous(AnyStencil const& stencil,
                                          typename AnyStencil::vector_type const& missing) {
  return stencil.template previous<Axis>(missing);
}

namespace detail {

/// True for the stencil of a stage at sites away from the ends of a row.
template <class Stencil>
inline constexpr bool is_along_row = false;
template <class Site, class Real>
inline constexpr bool is_along_row<Stencil<Site, Real, RowStencil<Real>>> = Site::is_between_ends;

/// Returns m_next - m_previous, with the zero vector for a missing neighbour. If no neighbour is
/// missing, it shares its loads with other terms.
template <int Axis, class AnyStencil>
KOKKOS_FORCEINLINE_FUNCTION typename AnyStencil::vector_type difference(AnyStencil const& stencil) {
  if constexpr (requires { stencil.template is_between<Axis>(); }) {
    if (stencil.template is_between<Axis>()) [[likely]]
      return stencil.template next<Axis>() - stencil.template previous<Axis>();
  }
  auto const none = zero<typename AnyStencil::value_type>();
  return stencil.template next<Axis>(none) - stencil.template previous<Axis>(none);
}

/// A stencil without neighbours: the value of a spin, which need not be in a field, and a site to
/// load coefficients from.
template <class Site>
class SpinAlone {
 public:
  using value_type = typename Site::value_type;
  using vector_type = Vec3<value_type>;

  KOKKOS_FORCEINLINE_FUNCTION SpinAlone(Site const& site, vector_type const& spin)
      : site_(site), spin_(spin) {}

  KOKKOS_FORCEINLINE_FUNCTION vector_type const& center() const { return spin_; }
  KOKKOS_FORCEINLINE_FUNCTION Site const& site() const { return site_; }

 private:
  Site const& site_;
  vector_type spin_;
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
