// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>

#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// Signs of sites: -1 where the sum of the indices along the axes selected by `along` is odd, 1
/// elsewhere.
struct AlternatingSigns {
  bool along[3] = {false, false, false};

  static AlternatingSigns along_axis(int axis) {
    AlternatingSigns signs;
    signs.along[axis] = true;
    return signs;
  }
  bool any() const { return along[0] || along[1] || along[2]; }

  /// Returns the sign of site 0 of a row.
  template <class Real>
  KOKKOS_FORCEINLINE_FUNCTION Real first_of_row(std::int32_t y, std::int32_t z) const {
    return ((along[1] ? y : 0) + (along[2] ? z : 0)) % 2 == 0 ? Real(1) : Real(-1);
  }

  template <class Value, class Site>
  KOKKOS_FORCEINLINE_FUNCTION Value at(Site const& site) const {
    using Real = scalar_t<Value>;
    auto const first = first_of_row<Real>(site.y(), site.z());
    if (!along[0]) return Value(first);
    Real signs[std::size_t{lanes_of<Value>}];
    for (int lane = 0; lane < lanes_of<Value>; ++lane)
      signs[lane] = (site.x() + lane) % 2 == 0 ? first : -first;
    return load<Value>(signs);
  }
};

}  // namespace cayspin::inline v0_2::detail
