// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

namespace cayspin::inline v0_2 {

/// The displacement of a spin, scale * direction. It has full relative precision even when it is
/// small.
template <class Value>
struct Displacement {
  Value scale;
  Vec3<Value> direction;

  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> from(Vec3<Value> const& m) const {
    return multiply_add(scale, direction, m);
  }
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> vector() const { return scale * direction; }
};

}  // namespace cayspin::inline v0_2
