// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/rotation/displacement.hpp>
#include <cayspin/rotation/half_angle.hpp>
#include <cayspin/vec3.hpp>

namespace cayspin::inline v0_2 {

/// The exponential map of so(3) (Rodrigues' rotation). Coordinates f stand for the rotation about f
/// by the angle |f|. No library sine is called, so that loops vectorise. The result is on the
/// sphere for every finite f. The angle has an error of about eps * |f|, where eps is the epsilon
/// of the precision; beyond |f| = 1/eps, only the axis of the rotation is meaningful.
struct Exponential {
  /// Returns exp(f) m.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> rotate(Vec3<Value> const& f,
                                                        Vec3<Value> const& m) {
    return displacement(f, m).from(m);
  }
  /// Returns exp(f) m - m.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Displacement<Value> displacement(Vec3<Value> const& f,
                                                                      Vec3<Value> const& m) {
    auto const half = detail::half_angle(f);
    // The unit quaternion (cosine, v) turns m into m + 2 * (cosine * v x m + v x (v x m)).
    Vec3<Value> const v = half.sine * half.direction;
    Vec3<Value> const c = cross(v, m);
    return {Value(2), multiply_add(half.cosine, c, cross(v, c))};
  }

  /// Returns dexp_f^-1 y = y - f x y / 2 + k * f x (f x y), where k = (1 - (n/2) * cot(n/2)) / n^2
  /// and n = |f| < 2 * pi.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> inverse_differential(Vec3<Value> const& f,
                                                                      Vec3<Value> const& y) {
    Vec3<Value> const c = cross(f, y);
    return multiply_add(detail::inverse_tangent_coefficient(f), cross(f, c),
                        multiply_add(Value(-0.5), c, y));
  }
};

}  // namespace cayspin::inline v0_2
