// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/rotation/cayley.hpp>
#include <cayspin/vec3.hpp>

#include <array>
#include <complex>
#include <cstddef>

namespace cayspin::inline v0_2::detail {

/// Gauss's collocation method with the tableau a_ij, b_j for dm/dt = w(t) x m on one site. Given
/// f_i = dt * w(t + nodes[i] * dt), it solves
///   Y_i = m + sum_j a_ij * f_j x Y_j, m1 = m + sum_j b_j * f_j x Y_j.
/// These linear equations are solved directly, without iteration, so that |m| is preserved for any
/// f. (Hairer, Lubich, Wanner 2006, Sec. II.1.3 and IV.2.1)
template <int Stages>
struct GaussLegendre;

template <>
struct GaussLegendre<1> {
  static constexpr std::array nodes{0.5};
  /// Eigenvalue of the matrix a_ij.
  static constexpr std::complex<double> eigenvalue{0.5, 0};

  /// Returns m1, which is cay(f[0]) m. `stage` becomes Y_1.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> solve(Vec3<Value> const (&f)[1],
                                                       Vec3<Value> const& m,
                                                       Vec3<Value> (&stage)[1]) {
    auto const step = Cayley::displacement(f[0], m);
    stage[0] = multiply_add(Value(Value(0.5) * step.scale), step.direction, m);
    return step.from(m);
  }
};

template <>
struct GaussLegendre<2> {
  static constexpr double sqrt3 = 1.7320508075688772;
  static constexpr std::array nodes{0.5 - sqrt3 / 6, 0.5 + sqrt3 / 6};
  /// Eigenvalue of the matrix a_ij with the eigenvector (1, i * turned). The other eigenvalue is
  /// its conjugate.
  static constexpr std::complex<double> eigenvalue{0.25, sqrt3 / 12};
  static constexpr double turned = -2 - sqrt3;

  /// Returns m1. `stage` becomes Y_1 and Y_2.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> solve(Vec3<Value> const (&f)[2],
                                                       Vec3<Value> const& m,
                                                       Vec3<Value> (&stage)[2]) {
    // With u = f_1 / 4, v = f_2 / 4, p_1 = u x Y_1, p_2 = v x Y_2:
    // Y_1 = m + p_1 + (1 - 2/sqrt3) * p_2, Y_2 = m + (1 + 2/sqrt3) * p_1 + p_2.
    // With the matrix [u] of the cross product, [u] w = u x w, the inverse of 1 - [u] is s * R,
    // where s = 1 / (1 + |u|^2) and R = 1 + [u] + u u^T. Eliminating Y_1 leaves a linear system for
    // Y_2, whose matrix has the rows a, b, c:
    //   Y_2 - p_2 + (s * R - 1) p_2 / 3 = m + (1 + 2/sqrt3) * (s * R - 1) m.
    auto const plus = as_value<Value>(1 + 2 / sqrt3), minus = as_value<Value>(1 - 2 / sqrt3);
    Vec3<Value> const u = Value(0.25) * f[0], v = Value(0.25) * f[1];
    Value const s = Value(1) / (Value(1) + dot(u, u));
    Value const third = as_value<Value>(1.0 / 3) * s;
    Value const one(1), none(0);
    Value const xy = u.x * u.y, xz = u.x * u.z, yz = u.y * u.z;
    Vec3<Value> const a = row(third, v, {multiply_add(u.x, u.x, one), xy - u.z, xz + u.y},
                              {one, none, none}, {none, Value(-v.z), v.y}),
                      b = row(third, v, {xy + u.z, multiply_add(u.y, u.y, one), yz - u.x},
                              {none, one, none}, {v.z, none, Value(-v.x)}),
                      c = row(third, v, {xz - u.y, yz + u.x, multiply_add(u.z, u.z, one)},
                              {none, none, one}, {Value(-v.y), v.x, none});
    Vec3<Value> const right = multiply_add(plus, turned_by(s, u, m), m), bc = cross(b, c);
    stage[1] =
        Value(one / dot(a, bc)) *
        multiply_add(right.x, bc, multiply_add(right.y, cross(c, a), Value(right.z) * cross(a, b)));
    Vec3<Value> const p2 = cross(v, stage[1]), w = multiply_add(minus, p2, m);
    stage[0] = w + turned_by(s, u, w);
    Vec3<Value> const change = Value(2) * (cross(u, stage[0]) + p2);
    // Corrects the length, which round-off would change by about |f| * epsilon.
    Value const longer = dot(change, multiply_add(Value(0.5), change, m)) / square_to_divide_by(m);
    return m + multiply_add(Value(-longer), m + change, change);
  }

 private:
  /// Returns (s * R - 1) w.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> turned_by(Value const& s, Vec3<Value> const& u,
                                                           Vec3<Value> const& w) {
    Vec3<Value> const c = cross(u, w);
    return s * (c + cross(u, c));
  }
  /// Returns a row of the matrix: unit - 4/3 * (unit x v) + s/3 * (r x v), for a unit vector `unit`
  /// and the row r of R. `third` is s/3, and `beside` is unit x v.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> row(Value const& third, Vec3<Value> const& v,
                                                     Vec3<Value> const& r, Vec3<Value> const& unit,
                                                     Vec3<Value> const& beside) {
    return multiply_add(third, cross(r, v), multiply_add(as_value<Value>(-4.0 / 3), beside, unit));
  }
};

}  // namespace cayspin::inline v0_2::detail
