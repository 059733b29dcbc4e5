// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/site.hpp>

// Reductions of float fields compute in double, and store their results as float.
namespace cayspin::inline v0_2::detail {

template <class Value, class Real>
KOKKOS_FORCEINLINE_FUNCTION void store_narrowed(Value const& value, Real* to) {
  if constexpr (std::is_same_v<scalar_t<Value>, Real>) {
    store(value, to);
  } else if constexpr (lanes_of<Value> == 1) {
    *to = static_cast<Real>(value);
  } else {
    scalar_t<Value> lane[lanes_of<Value>];
    store(value, lane);
    for (int i = 0; i < lanes_of<Value>; ++i) to[i] = static_cast<Real>(lane[i]);
  }
}

/// Stores three numbers per site in an array with the layout of the spins.
template <class Value, class Site, class Real>
KOKKOS_FORCEINLINE_FUNCTION void store_narrowed(Vec3<Value> const& value, Site const& site,
                                                SiteArray<Real, 3> const& array) {
  Real* const to = array.data + site.offset();
  store_narrowed(value.x, to);
  store_narrowed(value.y, to + array.stride);
  store_narrowed(value.z, to + 2 * array.stride);
}

}  // namespace cayspin::inline v0_2::detail
