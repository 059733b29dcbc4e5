// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/site.hpp>

namespace cayspin {

/// What a field term or generator sees: the spin of a site (of several sites at once on the host)
/// and its neighbours along the axes of the lattice.
template <class Site, class Real, class Spins = detail::SiteArray<Real, 3>>
class Stencil {
 public:
  using value_type = typename Site::value_type;
  using vector_type = Vec3<value_type>;

  KOKKOS_FORCEINLINE_FUNCTION Stencil(Site const& site, Spins const& spins)
      : site_(site), spins_(spins), center_(site.load_center(spins)) {}

  KOKKOS_FORCEINLINE_FUNCTION vector_type const& center() const { return center_; }

  /// The neighbour at index - 1; the spin itself where there is none.
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous() const {
    return site_.template neighbor<Axis, 0>(spins_, center_);
  }
  /// The neighbour at index + 1; the spin itself where there is none.
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next() const {
    return site_.template neighbor<Axis, 1>(spins_, center_);
  }

  /// The same with `missing` for a neighbour where there is none.
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous(vector_type const& missing) const {
    return neighbor_or<Axis, 0>(missing);
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next(vector_type const& missing) const {
    return neighbor_or<Axis, 1>(missing);
  }

  /// Position and loads of further per-site arrays (SiteField::array).
  KOKKOS_FORCEINLINE_FUNCTION Site const& site() const { return site_; }

 private:
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION vector_type neighbor_or(vector_type const& missing) const {
    if constexpr (Axis > 0) {
      if (!site_.row().template has_neighbor<Axis, Direction>()) return missing;
    }
    return site_.template neighbor<Axis, Direction>(spins_, missing);
  }

  Site const& site_;
  Spins const& spins_;
  vector_type center_;
};

}  // namespace cayspin
