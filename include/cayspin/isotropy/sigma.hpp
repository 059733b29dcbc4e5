// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

#include <limits>

namespace cayspin::inline v0_2::detail {

/// Returns numerator / square; zero if the square is too small to divide by.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value guarded_quotient(Value const& numerator, Value const& square) {
  auto const large_enough = Value(smallest_square<Value>()) < square;
  return select<Value>(large_enough, numerator, Value(0)) /
         select<Value>(large_enough, square, Value(1));
}

/// Limits a to [-cap, cap]; NaN stays NaN.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value clamp(Value const& a, Value const& cap) {
  Value const below = select<Value>(cap < a, cap, a);
  return select<Value>(below < Value(-cap), Value(-cap), below);
}

/// Returns dt * sigma = -<dt * w', w x m> / |w|^2, limited to [-cap, cap]; dt * w' is
/// `dt_times_rate`.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value turn_from_difference(Vec3<Value> const& dt_times_rate,
                                                       Vec3<Value> const& w, Vec3<Value> const& m,
                                                       Value const& cap) {
  Value const numerator = Value(0) - dot(dt_times_rate, cross(w, m));
  return clamp(guarded_quotient(numerator, dot(w, w)), cap);
}

}  // namespace cayspin::inline v0_2::detail
