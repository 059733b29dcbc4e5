// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/site.hpp>

namespace cayspin::inline v0_2::detail {

/// The neighbours of a site, loaded once.
template <class Site, class Real>
class NeighborsOfSite {
 public:
  using value_type = typename Site::value_type;
  using vector_type = Vec3<value_type>;

  KOKKOS_FORCEINLINE_FUNCTION NeighborsOfSite(Site const& site, SiteArray<Real, 3> const& spins)
      : site_(site) {
    auto const place = site.place(spins);
    vector_type center;
    site.load_row(spins, place, center, found_[0]);
    load<1, 0>(spins, place), load<1, 1>(spins, place);
    load<2, 0>(spins, place), load<2, 1>(spins, place);
  }

  KOKKOS_FORCEINLINE_FUNCTION Site const& site() const { return site_; }

  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION vector_type get(vector_type const& missing) const {
    vector_type const& found = found_[Axis][Direction];
    if constexpr (Axis == 0)
      return site_.template unless_past_end<Direction>(found, missing);
    else
      return site_.template has_neighbor<Axis, Direction>() ? found : missing;
  }

 private:
  template <int Axis, int Direction>
  KOKKOS_FORCEINLINE_FUNCTION void load(SiteArray<Real, 3> const& spins,
                                        typename Site::Place const& place) {
    found_[Axis][Direction] = site_.template has_neighbor<Axis, Direction>()
                                  ? site_.template neighbor<Axis, Direction>(spins, place)
                                  : zero<value_type>();
  }

  Site const& site_;
  vector_type found_[3][2];
};

/// A site's stencil with a different spin at its centre.
template <class Neighbors>
class VariedStencil {
 public:
  using value_type = typename Neighbors::value_type;
  using vector_type = typename Neighbors::vector_type;

  KOKKOS_FORCEINLINE_FUNCTION VariedStencil(Neighbors const& neighbors, vector_type const& center)
      : neighbors_(neighbors), center_(center) {}

  KOKKOS_FORCEINLINE_FUNCTION vector_type const& center() const { return center_; }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous() const {
    return neighbors_.template get<Axis, 0>(center_);
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next() const {
    return neighbors_.template get<Axis, 1>(center_);
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type previous(vector_type const& missing) const {
    return neighbors_.template get<Axis, 0>(missing);
  }
  template <int Axis>
  KOKKOS_FORCEINLINE_FUNCTION vector_type next(vector_type const& missing) const {
    return neighbors_.template get<Axis, 1>(missing);
  }
  KOKKOS_FORCEINLINE_FUNCTION auto const& site() const { return neighbors_.site(); }

 private:
  Neighbors const& neighbors_;
  vector_type center_;
};

}  // namespace cayspin::inline v0_2::detail
