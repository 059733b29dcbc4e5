// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/rotation/half_angle.hpp>
#include <cayspin/vec3.hpp>

#include <cstddef>

namespace cayspin::inline v0_2::detail {

/// exp(-x) and 1 - exp(-x), each to a few ulp, for 0 <= x < 700 in double, and 0 <= x < 80 in
/// float.
template <class Value>
struct Decay {
  Value rest, loss;
};

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Decay<Value> decay(Value const& x) {
  using Scalar = scalar_t<Value>;
  constexpr bool is_double = sizeof(Scalar) == sizeof(double);
  constexpr int terms = is_double ? 13 : 7;
  // ln 2 as a sum of two numbers. The first has few bits, so that its product with the number of
  // halvings is exact.
  constexpr double high = 0x1.62e42fefp-1, low = 0x1.473de6af278edp-34;
  constexpr float high_f = 0x1.62ep-1f, low_f = 0x1.0bfbe8p-15f;
  Value const halvings = nearest<Value>(Value(x * Value(Scalar(1.4426950408889634))));
  Value const minus = Value(Scalar(0)) - halvings;
  Value r = multiply_add(minus, Value(is_double ? Scalar(high) : Scalar(high_f)), x);
  r = multiply_add(minus, Value(is_double ? Scalar(low) : Scalar(low_f)), r);

  double coefficient[std::size_t{terms + 1}] = {1};  // of (1 - exp(-r)) / r, |r| < 0.35
  for (int k = 1; k <= terms; ++k) coefficient[k] = -coefficient[k - 1] / (k + 1);
  Value sum(static_cast<Scalar>(coefficient[terms]));
  for (int k = terms - 1; k >= 0; --k)
    sum = multiply_add(sum, r, Value(static_cast<Scalar>(coefficient[k])));
  Value const part = r * sum, half = power_of_two<Value>(minus);
  return {multiply_add(Value(Scalar(0)) - half, part, half),
          multiply_add(half, part, Value(Scalar(1)) - half)};
}

/// The exact motion of one spin q in a fixed field h over a time dt:
/// q' = (h + damping * q x h) x q, or without precession q' = (damping * q x h) x q.
/// With e = h/|h| and c = q.e: with precession, q turns about e by the angle |h| * dt. With or
/// without it, c becomes (c + th)/(1 + c * th), where th = tanh(damping * |h| * dt). q stays on the
/// sphere for any finite dt, damping and h.
template <class Value>
struct ExactFlow {
  using Scalar = scalar_t<Value>;
  using Mask = typename ValueTraits<Value>::mask;
  Value damping;
  Scalar dt;
  bool precession, damped;

  /// Returns q after the time dt. The results in the lanes that `others` marks are arbitrary.
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const& h, Vec3<Value> const& q,
                                                     Mask const& others) const {
    Vec3<Value> const f = Value(dt) * h;
    Value const turn2 = dot(f, f), damping2 = damping * damping;
    auto const near = turn2 < Value(Scalar(2.25)) && damping2 * turn2 < Value(Scalar(0.25));
    Vec3<Value> const end = small(f, turn2, q);
    if (holds_everywhere(Mask(near || others))) return end;
    Vec3<Value> const far = large(h, q);
    return select<Value>(near, end, far);
  }

  /// Returns q after the time dt/2, to first order in dt; q itself if the change would have a
  /// length of 1 or more.
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> middle(Vec3<Value> const& h, Vec3<Value> const& q) const {
    Vec3<Value> const relaxing = damping * cross(q, h);
    Vec3<Value> const a = precession ? h + relaxing : relaxing;
    Vec3<Value> const way = Value(Scalar(0.5) * dt) * cross(a, q);
    auto const near = dot(way, way) < Value(Scalar(1));
    return select<Value>(near, q + way, q);
  }

 private:
  /// Returns the sum over k = 0 .. Terms - 1 of first * x^k / ((Odd + 1) * .. * (Odd + 2 * k)).
  /// Even and odd k are summed separately, which halves the chain of dependent operations.
  template <int Odd, int Terms>
  KOKKOS_FORCEINLINE_FUNCTION static Value series(Value const& x, double first) {
    double coefficient[std::size_t{Terms}] = {first};
    for (int k = 1; k < Terms; ++k)
      coefficient[k] = coefficient[k - 1] / ((2 * k + Odd) * (2 * k - 1 + Odd));
    auto const term = [&](int k) { return Value(static_cast<Scalar>(coefficient[k])); };
    Value const square = x * x;
    Value upper = term(Terms - 1), lower = term(Terms - 2);
    for (int k = Terms - 3; k > 0; k -= 2) {
      upper = multiply_add(upper, square, term(k));
      lower = multiply_add(lower, square, term(k - 1));
    }
    if constexpr (Terms % 2 == 0) return multiply_add(upper, x, lower);
    return multiply_add(lower, x, multiply_add(upper, square, term(0)));
  }

  /// Returns q after the time dt for |f| < 3/2 and damping * |f| < 1/2, where f = dt * h and turn2
  /// = |f|^2. All functions are power series in |f|^2, so that no root is needed. Damping turns q
  /// towards f by the formula of relativistic aberration.
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> small(Vec3<Value> const& f, Value const& turn2,
                                                Vec3<Value> const& q) const {
    constexpr bool is_double = sizeof(Scalar) == sizeof(double);
    Vec3<Value> turned = q;
    if (precession) {
      Value const x = Value(Scalar(-0.25)) * turn2;
      constexpr int cosine_terms = is_double ? 9 : 6, sine_terms = is_double ? 9 : 5;
      Value const cosine = series<0, cosine_terms>(x, 1);
      Vec3<Value> const v = series<1, sine_terms>(x, 0.5) * f;
      Vec3<Value> const c = cross(v, q);
      turned = multiply_add(Value(Scalar(2)), multiply_add(cosine, c, cross(v, c)), q);
    }
    if (!damped) return turned;
    Value const y = damping * damping * turn2;
    constexpr int sine_terms = is_double ? 8 : 4, rise_terms = is_double ? 7 : 4;
    Value const sine = damping * series<1, sine_terms>(y, 1);  // sinh(sqrt(y)) / |f|
    Value const rise = series<2, rise_terms>(y, 0.5);          // (cosh(sqrt(y)) - 1) / y
    Value const along = dot(f, q);
    Value const growth = multiply_add(y, rise, Value(sine * along));
    Value const pull = multiply_add(Value(damping * damping * rise), along, sine);
    Value const scale = Value(Scalar(1)) / (Value(Scalar(1)) + growth);
    return kept_on_sphere(
        multiply_add(Value(scale * pull), f,
                     multiply_add(Value(Value(Scalar(0)) - scale * growth), turned, turned)),
        y == Value(Scalar(0)));
  }

  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> large(Vec3<Value> const& h, Vec3<Value> const& q) const {
    constexpr bool is_double = sizeof(Scalar) == sizeof(double);
    constexpr Scalar largest = is_double ? Scalar(1e300) : Scalar(1e37f);
    auto const norm = scaled_norm(h);
    Value const divisor =
        select<Value>(norm.scaled_norm == Value(Scalar(0)), Value(Scalar(1)), norm.scaled_norm);
    // A step backwards in time is a step forwards in the opposite field.
    Vec3<Value> const e = Value(Value(dt < 0 ? Scalar(-1) : Scalar(1)) / divisor) * norm.scaled;
    Value angle = Value(dt < 0 ? -dt : dt) * norm.norm;
    angle = select<Value>(angle < Value(largest), angle, Value(largest));
    Vec3<Value> const turned = precession ? turn(angle, e, q) : q;
    return damped ? relax(angle, e, turned) : turned;
  }

  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> turn(Value const& angle, Vec3<Value> const& e,
                                                      Vec3<Value> const& q) {
    auto const half = half_turn(angle);
    Vec3<Value> const v = Value(half.r * half.sine_over_r) * e;
    Vec3<Value> const c = cross(v, q);
    return multiply_add(Value(Scalar(2)), multiply_add(half.cosine, c, cross(v, c)), q);
  }

  /// Returns q after relaxation: q + (1 - p) * (a * (e - q) + p * b * (e + q)) / (a + p^2 * b),
  /// where c = q.e, p = exp(-damping * angle), a = 1 + c and b = 1 - c. The smaller of a and b is
  /// computed from the part of q normal to e, which avoids cancellation. Otherwise a spin nearly
  /// opposite to the field would leave that direction too early or too late.
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> relax(Value const& angle, Vec3<Value> const& e,
                                                Vec3<Value> const& q) const {
    constexpr Scalar longest = sizeof(Scalar) == sizeof(double) ? Scalar(340) : Scalar(40);
    Value const zero(Scalar(0)), one(Scalar(1));
    Value x = damping * angle;
    x = select<Value>(x < Value(longest), x, Value(longest));
    auto const [p, loss] = decay(x);
    Value const c = dot(q, e);
    Vec3<Value> const across = multiply_add(Value(zero - c), e, q);
    Value const larger = one + Kokkos::abs(c), smaller = dot(across, across) / larger;
    auto const opposite = c < zero;
    Value const a = select<Value>(opposite, smaller, larger);
    Value const pb = p * select<Value>(opposite, larger, smaller);
    Value const scale = loss / multiply_add(p, pb, a);
    return kept_on_sphere(
        multiply_add(Value(scale * a), e - q, multiply_add(Value(scale * pb), e + q, q)),
        x == zero);
  }

  /// Returns q after one Newton step towards length 1. For a spin nearly opposite to the field, an
  /// error in the length would grow as fast as the angle between the spin and the direction
  /// opposite to the field. Spins that `rests` marks (no field or no damping) are returned bitwise
  /// unchanged.
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> kept_on_sphere(Vec3<Value> const& q,
                                                                Mask const& rests) {
    Value const factor = multiply_add(Value(Scalar(-0.5)), dot(q, q), Value(Scalar(1.5)));
    return select<Value>(rests, Value(Scalar(1)), factor) * q;
  }
};

}  // namespace cayspin::inline v0_2::detail
