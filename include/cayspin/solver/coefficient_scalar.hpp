// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/pack.hpp>

#include <Kokkos_Complex.hpp>
#include <Kokkos_Core.hpp>

#include <concepts>

// Real and complex coefficients of linear systems. A complex number of a field is two real ones.
namespace cayspin::detail {

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

/// sum += a x
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION void multiply_add_to(Real a, Real const (&x)[1], Real (&sum)[1]) {
  sum[0] = multiply_add(a, x[0], sum[0]);
}
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION void multiply_add_to(Kokkos::complex<Real> const& a, Real const (&x)[2],
                                                 Real (&sum)[2]) {
  sum[0] = multiply_add(Real(-a.imag()), x[1], multiply_add(a.real(), x[0], sum[0]));
  sum[1] = multiply_add(a.imag(), x[0], multiply_add(a.real(), x[1], sum[1]));
}

/// rest -= a x
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION void multiply_subtract_from(Real a, Real const (&x)[1],
                                                        Real (&rest)[1]) {
  rest[0] = multiply_add(-a, x[0], rest[0]);
}
template <class Real>
KOKKOS_FORCEINLINE_FUNCTION void multiply_subtract_from(Kokkos::complex<Real> const& a,
                                                        Real const (&x)[2], Real (&rest)[2]) {
  rest[0] = multiply_add(a.imag(), x[1], multiply_add(Real(-a.real()), x[0], rest[0]));
  rest[1] = multiply_add(Real(-a.imag()), x[0], multiply_add(Real(-a.real()), x[1], rest[1]));
}

}  // namespace cayspin::detail
