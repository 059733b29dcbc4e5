// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/generator/rigid_body.hpp>
#include <cayspin/isotropy/sigma.hpp>
#include <cayspin/vec3.hpp>

namespace cayspin::inline v0_2::isotropy {

/// Correction for rigid bodies that adds dt^p * s * m to the coordinates F of a step from m; p is 3
/// for LieHeun, and 4 for Rkmk4 and Series4. The number s is chosen so that the leading energy
/// error of the step cancels. On a body in steady rotation the correction has no effect. The
/// formulas are those of Lewis and Nigam 2002, Sec. 5.2, in coordinate-free form for any symmetric
/// inertia.
struct Energy {};

}  // namespace cayspin::inline v0_2::isotropy

namespace cayspin::inline v0_2::detail {

/// The quantities of B = I^-1 and m on which the corrections depend.
template <class Value>
struct BodyInvariants {
  Vec3<Value> bm, v;                 // B m, m x B m
  Value b, b2, v2;                   // <m, B m>, |B m|^2, |v|^2
  Value trace, second, det;          // of B
  Value mixed;                       // <m, B m x B^2 m>
  Value trace_c, second_c, cubic_c;  // of C = B - b; cubic_c: <C m, C C m> / |C m|^2

  KOKKOS_FORCEINLINE_FUNCTION BodyInvariants(SymmetricMatrix<Value> const& matrix,
                                             Vec3<Value> const& m) {
    bm = matrix * m;
    v = cross(m, bm);
    b = dot(m, bm);
    b2 = dot(bm, bm);
    v2 = dot(v, v);
    trace = matrix.xx + matrix.yy + matrix.zz;
    second = matrix.xx * matrix.yy + matrix.yy * matrix.zz + matrix.zz * matrix.xx -
             matrix.xy * matrix.xy - matrix.yz * matrix.yz - matrix.xz * matrix.xz;
    det = matrix.xx * (matrix.yy * matrix.zz - matrix.yz * matrix.yz) -
          matrix.xy * (matrix.xy * matrix.zz - matrix.yz * matrix.xz) +
          matrix.xz * (matrix.xy * matrix.yz - matrix.yy * matrix.xz);
    mixed = dot(m, cross(bm, matrix * bm));
    trace_c = trace - Value(3) * b;
    second_c = second - Value(2) * b * trace + Value(3) * b * b;
    Vec3<Value> const cm = bm - b * m;
    cubic_c = guarded_quotient(dot(cm, matrix * cm), v2) - b;
  }
};

struct HeunCorrection {
  static constexpr int power = 3;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value sigma(SymmetricMatrix<Value> const& matrix,
                                                 Vec3<Value> const& m, bool orthogonal) {
    BodyInvariants<Value> const body(matrix, m);
    if (orthogonal)
      return Value(0.25) * (Value(3) * body.v2 + body.second_c) * (body.trace_c - body.cubic_c);
    Vec3<Value> const bv = matrix * body.v;
    return guarded_quotient(Value(Value(0.25) * dot(bv, body.trace * bv - matrix * bv)), body.v2);
  }
};

struct Rkmk4Correction {
  static constexpr int power = 4;
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value sigma(SymmetricMatrix<Value> const& matrix,
                                                 Vec3<Value> const& m, bool orthogonal) {
    BodyInvariants<Value> const body(matrix, m);
    if (orthogonal) return Value(-1. / 16) * body.mixed * (body.trace_c - body.cubic_c);
    Value const form = Value(3) * body.second * body.b + Value(5) * body.b * body.b2 - body.det -
                       Value(4) * body.trace * body.b * body.b;
    return guarded_quotient(Value(Value(1. / 48) * body.mixed * form), body.v2);
  }
};

/// Returns F + dt^p * s * m, where m is the spin at the start of the step.
template <class Correction, class Generator, class Site, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> corrected(Generator const& generator, Site const& site,
                                                  Vec3<Value> const& f, Vec3<Value> const& m,
                                                  Value const& dt) {
  static_assert(
      requires { generator.template inverse_inertia<Value>(site); },
      "isotropy::Energy is for rigid bodies only; for other generators there is EnergyControl.");
  Value scale = dt;
  for (int i = 1; i < Correction::power; ++i) scale = scale * dt;
  bool orthogonal = false;
  if constexpr (requires { generator.is_orthogonal(); }) orthogonal = generator.is_orthogonal();
  Value const sigma =
      Correction::sigma(generator.template inverse_inertia<Value>(site), m, orthogonal);
  return multiply_add(Value(scale * sigma), m, f);
}

}  // namespace cayspin::inline v0_2::detail
