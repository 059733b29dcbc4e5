// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

namespace cayspin::isotropy {

/// The same sigma for every spin, stage and step, added to A along m.
struct Constant {
  double sigma = 0;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const& m,
                                                     Vec3<Value> const& a) const {
    return multiply_add(Value(static_cast<detail::scalar_t<Value>>(sigma)), m, a);
  }
};

}  // namespace cayspin::isotropy
