// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/pack.hpp>

#include <Kokkos_Complex.hpp>
#include <Kokkos_Core.hpp>

#include <concepts>

// Real and complex coefficients of linear systems. Fields store a complex number as two real ones.
namespace cayspin::inline v0_2::detail {

template <class Scalar>
struct RealPart {
  using type = Scalar;
};
template <class Real>
struct RealPart<Kokkos::complex<Real>> {
  using type = Real;
};
template <class Scalar>
using real_part_t = typename RealPart<Scalar>::type;

template <class Scalar>
inline constexpr int real_parts = std::floating_point<Scalar> ? 1 : 2;

/// Adds a * x to sum, for a real or complex a and x.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION void multiply_add_to(scalar_t<Value> a, Value const (&x)[1],
                                                 Value (&sum)[1]) {
  sum[0] = multiply_add(Value(a), x[0], sum[0]);
}
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION void multiply_add_to(Kokkos::complex<scalar_t<Value>> const& a,
                                                 Value const (&x)[1], Value (&sum)[2]) {
  sum[0] = multiply_add(Value(a.real()), x[0], sum[0]);
  sum[1] = multiply_add(Value(a.imag()), x[0], sum[1]);
}
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION void multiply_add_to(Kokkos::complex<scalar_t<Value>> const& a,
                                                 Value const (&x)[2], Value (&sum)[2]) {
  sum[0] = multiply_add(Value(-a.imag()), x[1], multiply_add(Value(a.real()), x[0], sum[0]));
  sum[1] = multiply_add(Value(a.imag()), x[0], multiply_add(Value(a.real()), x[1], sum[1]));
}

}  // namespace cayspin::inline v0_2::detail
