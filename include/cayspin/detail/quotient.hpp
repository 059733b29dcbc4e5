// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/pack.hpp>

#include <type_traits>

namespace cayspin::inline v0_2::detail {

/// Returns a / b with an error of less than one unit in the last place. `inverse` is 1 / b to at
/// least 18 bits.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value refined_quotient(Value const& a, Value const& b, Value inverse) {
  Value const error = Kokkos::fma(-b, inverse, Value(1));
  inverse = Kokkos::fma(inverse, Kokkos::fma(error, error, error), inverse);
  Value const quotient = a * inverse;
  return Kokkos::fma(Kokkos::fma(-b, quotient, a), inverse, quotient);
}

/// Returns a / b if b and 1 / b are normal numbers. On CUDA this is faster than an ordinary
/// division, which tests for operands near the ends of their range and calls a function for those.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value quotient(Value const& a, Value const& b) {
#if defined(CAYSPIN_DETAIL_ROUGH_INVERSE)
  return refined_quotient(a, b, rough_inverse(b));
#else
  return a / b;
#endif
}

}  // namespace cayspin::inline v0_2::detail
