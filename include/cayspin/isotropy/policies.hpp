// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

#include <limits>

// An isotropy policy turns the generator's A at a spin m into xi = A + sigma m. The exact flow does
// not depend on sigma. Methods of finite order do.
namespace cayspin::inline v0_1::isotropy {

/// sigma = 0: the generator as it is.
struct Zero {
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const&,
                                                     Vec3<Value> const& a) const {
    return a;
  }
};

/// The same sigma for every spin, stage and step.
struct Constant {
  double sigma = 0;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const& m,
                                                     Vec3<Value> const& a) const {
    return multiply_add(Value(static_cast<detail::scalar_t<Value>>(sigma)), m, a);
  }
};

/// sigma from a forward difference of A_o = A - (m.A) m: xi = A_o + sigma m with
/// sigma = -<w', w x m> / |w|^2, w = A_o. A second evaluation at cay(dt w) m, t + dt gives w'. It
/// makes the energy error of LieEuler one order smaller. Lewis and Nigam 2002, Sec. 4.1, with
/// the sign and the norm corrected. Zero if A_o is zero.
struct FiniteDifference {
  double cap = std::numeric_limits<double>::infinity();  ///< of |dt sigma|
};

/// FiniteDifference with w' = (w_n - w_(n-1)) / dt: one evaluation per step, and a field that keeps
/// w. The first step takes the forward difference.
struct FiniteDifferenceBackward {
  double cap = std::numeric_limits<double>::infinity();  ///< of |dt sigma|
};

}  // namespace cayspin::inline v0_1::isotropy
