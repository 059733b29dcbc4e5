// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

#include <limits>
#include <type_traits>

// An isotropy policy turns the generator's A at a spin m into xi = A + sigma * m. The exact flow is
// independent of sigma; methods of finite order are not.
namespace cayspin::inline v0_2::isotropy {

/// sigma = 0: uses the generator unchanged.
struct Zero {
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const&,
                                                     Vec3<Value> const& a) const {
    return a;
  }
};

/// A constant sigma for all spins, stages and steps. Steppers throw std::invalid_argument when it
/// is not finite.
struct Constant {
  double sigma = 0;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const& m,
                                                     Vec3<Value> const& a) const {
    return multiply_add(Value(static_cast<detail::scalar_t<Value>>(sigma)), m, a);
  }
};

/// sigma from a forward difference of A_o = A - (m.A) * m: xi = A_o + sigma * m with w = A_o and
/// sigma = -<w', w x m> / |w|^2. The derivative w' comes from a second evaluation, at cay(dt * w) m
/// and t + dt. This sigma raises the order of LieEuler's energy error by one. Lewis and Nigam 2002,
/// Sec. 4.1, with the sign and the norm corrected. If A_o is zero, so is sigma.
struct FiniteDifference {
  double cap = std::numeric_limits<double>::infinity();  ///< bound on |dt * sigma|
};

/// FiniteDifference with the backward difference w' = (w_n - w_(n-1)) / (previous dt): one
/// evaluation per step instead of two. w is kept for the next step. The first step uses the forward
/// difference.
struct FiniteDifferenceBackward {
  double cap = std::numeric_limits<double>::infinity();  ///< bound on |dt * sigma|
};

}  // namespace cayspin::inline v0_2::isotropy

namespace cayspin::inline v0_2::detail {

/// Returns the policy; throws std::invalid_argument for a Constant whose sigma is not finite.
template <class Isotropy>
Isotropy checked_policy(Isotropy const& policy) {
  if constexpr (std::is_same_v<Isotropy, isotropy::Constant>)
    finite(policy.sigma, "cayspin::isotropy::Constant: sigma");
  return policy;
}

}  // namespace cayspin::inline v0_2::detail
