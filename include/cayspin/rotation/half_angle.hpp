// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

#include <cstddef>

namespace cayspin::inline v0_2::detail {

/// Returns the Taylor polynomial of sin(a)/a (Odd = 1) or cos(a) (Odd = 0) in x = a^2, which is 1 +
/// x/c1 * (1 + x/c2 * (1 + ...)) with ck = -(2 * k + Odd) * (2 * k - 1 + Odd). For |a| <= 1.62 the
/// first omitted term is below a quarter of the epsilon of the precision.
template <int Odd, class Value>
KOKKOS_FORCEINLINE_FUNCTION Value trigonometric_series(Value const& x) {
  constexpr int terms = sizeof(scalar_t<Value>) == sizeof(double) ? 10 : 6;
  double coefficient[std::size_t{terms + 1}] = {1};
  for (int k = 1; k <= terms; ++k)
    coefficient[k] = -coefficient[k - 1] / ((2 * k + Odd) * (2 * k - 1 + Odd));
  Value sum(static_cast<scalar_t<Value>>(coefficient[terms]));
  for (int k = terms - 1; k >= 0; --k)
    sum = multiply_add(sum, x, Value(static_cast<scalar_t<Value>>(coefficient[k])));
  return sum;
}

/// The rotation by f as a unit quaternion: cosine is cos(|f|/2), and sine * direction is the vector
/// sin(|f|/2) * f/|f|. Cosine and vector may also both have the opposite sign, which gives the same
/// rotation.
template <class Value>
struct HalfAngle {
  Value sine, cosine;
  Vec3<Value> direction;
};

/// The norm |f|, computed without overflow of its square. `scaled` is f or, if f is large, f times
/// a small power of two.
template <class Value>
struct ScaledNorm {
  Vec3<Value> scaled;
  Value scaled_norm, norm;
};

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION ScaledNorm<Value> scaled_norm(Vec3<Value> const& f) {
  using Scalar = scalar_t<Value>;
  constexpr bool is_double = sizeof(Scalar) == sizeof(double);
  constexpr Scalar large = is_double ? Scalar(0x1p500) : Scalar(0x1p60f);
  constexpr Scalar down = is_double ? Scalar(0x1p-600) : Scalar(0x1p-80f);
  constexpr Scalar up = is_double ? Scalar(0x1p600) : Scalar(0x1p80f);
  Value const largest =
      maximum<Value>(Kokkos::abs(f.x), maximum<Value>(Kokkos::abs(f.y), Kokkos::abs(f.z)));
  auto const too_large = Value(large) < largest;
  Value const scale = select<Value>(too_large, Value(down), Value(Scalar(1)));
  Vec3<Value> const scaled = scale * f;
  Value const norm = square_root<Value>(dot(scaled, scaled));
  return {scaled, norm, norm * select<Value>(too_large, Value(up), Value(Scalar(1)))};
}

/// The sine and the cosine of half an angle; both may have the opposite sign. The sine is r *
/// sine_over_r, where r is half the angle minus a multiple of pi.
template <class Value>
struct HalfTurn {
  Value r, sine_over_r, cosine;
};

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION HalfTurn<Value> half_turn(Value const& angle) {
  using Scalar = scalar_t<Value>;
  constexpr bool is_double = sizeof(Scalar) == sizeof(double);
  Value const a = Value(Scalar(0.5)) * angle;

  // Subtracts the nearest multiple of pi, with pi as a sum of three numbers. If rounding a / pi
  // gives the wrong multiple, |r| exceeds pi / 2 by about a * epsilon. The clamp acts only if this
  // excess is large, and keeps the result on the sphere. An fma does not round its product, even on
  // machines without such an instruction.
  constexpr double pi = 3.14159265358979311600e+00, pi_low = 1.22464679914735317636e-16,
                   pi_lowest = -2.99476980971833966592e-33;
  constexpr float pi_f = 3.14159274101257324f, pi_low_f = -8.74227800037247e-08f,
                  pi_lowest_f = -3.42e-15f;
  constexpr Scalar limit = Scalar(1.62);
  Value const turns = nearest<Value>(Value(a * Value(Scalar(1 / pi))));
  Value const minus = Value(Scalar(0)) - turns;
  Value r = Kokkos::fma(minus, Value(is_double ? Scalar(pi) : Scalar(pi_f)), a);
  r = Kokkos::fma(minus, Value(is_double ? Scalar(pi_low) : Scalar(pi_low_f)), r);
  r = Kokkos::fma(minus, Value(is_double ? Scalar(pi_lowest) : Scalar(pi_lowest_f)), r);
  r = select<Value>(r < Value(limit), r, Value(limit));
  r = select<Value>(Value(-limit) < r, r, Value(-limit));

  Value const x = r * r;
  return {r, trigonometric_series<1>(x), trigonometric_series<0>(x)};
}

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION HalfAngle<Value> half_angle(Vec3<Value> const& f) {
  using Scalar = scalar_t<Value>;
  constexpr bool is_double = sizeof(Scalar) == sizeof(double);
  auto const [scaled, scaled_length, length] = scaled_norm(f);
  auto const [r, sine_over_r, cosine] = half_turn(length);
  // If |f|^2 is close to or below the smallest normal number, |f| is inaccurate; then f/2 replaces
  // sin(|f|/2) * f/|f|.
  auto const tiny = scaled_length < Value(is_double ? Scalar(0x1p-500) : Scalar(0x1p-60f));
  Value const safe = select<Value>(tiny, Value(Scalar(1)), scaled_length);
  return {select<Value>(tiny, Value(Scalar(0.5)), Value(r * sine_over_r / safe)), cosine, scaled};
}

/// Returns (1 - (n/2) * cot(n/2)) / n^2 for n = |f|; 1/12 if f is 0.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value inverse_tangent_coefficient(Vec3<Value> const& f) {
  using Scalar = scalar_t<Value>;
  Value const square = dot(f, f);
  // For n < 1/2 the closed form would suffer from cancellation. There the series with the terms
  // |B_2k| * n^(2k-2) / (2k)! is used, where B_2k are Bernoulli numbers; its first omitted term is
  // below 1e-18.
  constexpr double series[] = {1. / 12,           1. / 720,
                               1. / 30240,        1. / 1209600,
                               1. / 47900160,     691. / 1307674368000,
                               1. / 74724249600., 3617. / 10670622842880000.};
  constexpr int terms = sizeof(series) / sizeof(series[0]);
  Value sum{static_cast<Scalar>(series[terms - 1])};
  for (int k = terms - 2; k >= 0; --k)
    sum = multiply_add(sum, square, Value(static_cast<Scalar>(series[k])));

  auto const half = half_angle(f);
  Value const a = Value(Scalar(0.5)) * square_root<Value>(square);
  Value const sine = half.sine * Value(Scalar(2)) * a;
  auto const small = square < Value(Scalar(0.25));
  Value const divisor = select<Value>(small, Value(Scalar(1)), Value(sine * square));
  Value const closed = (sine - a * half.cosine) / divisor;
  return select<Value>(small, sum, closed);
}

}  // namespace cayspin::inline v0_2::detail
