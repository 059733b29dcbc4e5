// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

namespace cayspin::isotropy {

/// sigma = 0: the generator as it is. An isotropy policy turns the generator's A at a spin m into
/// xi = A + sigma m, which moves m alike for every sigma; methods of finite order differ.
struct Zero {
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const&,
                                                     Vec3<Value> const& a) const {
    return a;
  }
};

}  // namespace cayspin::isotropy
