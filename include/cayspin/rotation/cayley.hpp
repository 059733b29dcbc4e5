// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/quotient.hpp>
#include <cayspin/rotation/displacement.hpp>
#include <cayspin/vec3.hpp>

namespace cayspin::inline v0_2 {

/// The Cayley map of so(3). Coordinates f stand for the rotation about f by the angle 2 *
/// atan(|f|/2). The differential is right-trivialised. Lewis and Nigam 2002, Sec. 2.
struct Cayley {
  /// Returns cay(f) m, to a few ulp, for |f| up to about 1e150 (double) or 1e18 (float).
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> rotate(Vec3<Value> const& f,
                                                        Vec3<Value> const& m) {
    // Written as m plus a small change: the equivalent quotient form drifts off the sphere.
    return displacement(f, m).from(m);
  }
  /// Returns cay(f) m - m.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Displacement<Value> displacement(Vec3<Value> const& f,
                                                                      Vec3<Value> const& m) {
    Vec3<Value> const c = cross(f, m);
    Value const four_and_f2 = detail::multiply_add(
        f.x, f.x, detail::multiply_add(f.y, f.y, detail::multiply_add(f.z, f.z, Value(4))));
    return {detail::quotient(Value(4), four_and_f2), multiply_add(Value(0.5), cross(f, c), c)};
  }

  /// Returns dcay_f y = (y + f x y / 2) / (1 + |f|^2 / 4).
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> differential(Vec3<Value> const& f,
                                                              Vec3<Value> const& y) {
    Vec3<Value> const h = Value(0.5) * f;
    return Value(Value(1) / (Value(1) + dot(h, h))) * (y + cross(h, y));
  }

  /// Returns dcay_f^-1 y = y - f x y / 2 + <f, y> * f / 4.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> inverse_differential(Vec3<Value> const& f,
                                                                      Vec3<Value> const& y) {
    return multiply_add(Value(Value(0.25) * dot(f, y)), f,
                        multiply_add(Value(-0.5), cross(f, y), y));
  }
};

/// The Cayley map for any finite f, without overflow of intermediate results. Somewhat slower than
/// Cayley. Only inverse_differential, which is inherited, can overflow.
struct OverflowSafeCayley : Cayley {
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> rotate(Vec3<Value> const& f,
                                                        Vec3<Value> const& m) {
    return displacement(f, m).from(m);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Displacement<Value> displacement(Vec3<Value> const& f,
                                                                      Vec3<Value> const& m) {
    Vec3<Value> const h = Value(0.5) * f;
    Value const t = Value(1) / largest_or_one(h);
    Vec3<Value> const p = t * h;
    Vec3<Value> const c = cross(p, m);
    Value const scale = Value(2) / detail::multiply_add(t, t, dot(p, p));
    return {scale, multiply_add(t, c, cross(p, c))};
  }

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> differential(Vec3<Value> const& f,
                                                              Vec3<Value> const& y) {
    Vec3<Value> const h = Value(0.5) * f;
    Value const t = Value(1) / largest_or_one(h);
    Vec3<Value> const p = t * h;
    Value const scale = t / detail::multiply_add(t, t, dot(p, p));
    return scale * multiply_add(t, y, cross(p, y));
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value largest_or_one(Vec3<Value> const& h) {
    Value const yz = detail::maximum<Value>(Kokkos::abs(h.y), Kokkos::abs(h.z));
    return detail::maximum<Value>(Value(1), detail::maximum<Value>(Kokkos::abs(h.x), yz));
  }
};

}  // namespace cayspin::inline v0_2
