// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

#include <type_traits>

// How an increment moves a spin, and which increment a generator gives at a stage: the part of a
// Runge-Kutta method that is geometry. Coordinates f are taken at the spin m0 of the step's begin;
// increment(f, dt A, m, m0) belongs to the stage's spin m, which f moves m0 to.
namespace cayspin::update {

/// Runge-Kutta-Munthe-Kaas: f in the Lie algebra, m = Rotation(f) m0, f' = dRotation_f^-1 (A).
template <class Rotation>
struct Lie {
  static constexpr bool increment_needs_argument = true;
  static constexpr bool keeps_generators = false;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> increment(Vec3<Value> const& f,
                                                           Vec3<Value> const& step_times_a,
                                                           Vec3<Value> const&, Vec3<Value> const&) {
    return Rotation::inverse_tangent(f, step_times_a);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> move(Vec3<Value> const& f, Vec3<Value> const& m0) {
    return Rotation::rotate(f, m0);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> finish(Vec3<Value> const& f,
                                                        Vec3<Value> const& m0) {
    return Rotation::rotate(f, m0);
  }
};

/// As Lie, with the generators themselves as increments: the inverse tangent is left out. Keeps the
/// order of methods up to 2 alone. Lewis and Nigam 2002, Sec. 4.3.
template <class Rotation>
struct LieUncorrected : Lie<Rotation> {
  static constexpr bool increment_needs_argument = false;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> increment(Vec3<Value> const&,
                                                           Vec3<Value> const& step_times_a,
                                                           Vec3<Value> const&, Vec3<Value> const&) {
    return step_times_a;
  }
};

/// As printed in Lewis and Nigam 2002, Sec. 4.4: stages 3 and 4 take their argument from the
/// generators A_2, A_3 where the increments F_2, F_3 are meant. Order 3; kept for reproduction.
template <class Rotation>
struct LieAsPrinted : Lie<Rotation> {
  static constexpr bool keeps_generators = true;
};

/// Classical Runge-Kutta in space: f is a displacement. Renormalise: divide by the length at the
/// end of each step, which is what most spin codes do.
template <bool Renormalise>
struct Classical {
  static constexpr bool increment_needs_argument = false;
  static constexpr bool keeps_generators = false;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> increment(Vec3<Value> const&,
                                                           Vec3<Value> const& step_times_a,
                                                           Vec3<Value> const& m,
                                                           Vec3<Value> const&) {
    return cross(step_times_a, m);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> move(Vec3<Value> const& f, Vec3<Value> const& m0) {
    return m0 + f;
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> finish(Vec3<Value> const& f,
                                                        Vec3<Value> const& m0) {
    Vec3<Value> const m = m0 + f;
    if constexpr (Renormalise) {
      return Value(Value(1) / detail::square_root<Value>(dot(m, m))) * m;
    } else {
      return m;
    }
  }
};

/// Classical Runge-Kutta in the stereographic chart at m0: f is normal to m0 and stands for the
/// rotation cay(2 m0 x f), every stage's coordinates staying orthogonal to m0. Not in the paper.
/// Breaks down only where a stage's spin reaches -m0.
struct Stereographic {
  static constexpr bool increment_needs_argument = false;
  static constexpr bool keeps_generators = false;
  static constexpr bool has_chart = true;  // f can be had back from the spin it moves m0 to

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> increment(Vec3<Value> const&,
                                                           Vec3<Value> const& step_times_a,
                                                           Vec3<Value> const& m,
                                                           Vec3<Value> const& m0) {
    Vec3<Value> const u = cross(step_times_a, m);
    Vec3<Value> const e = m + m0;
    Value const scale = Value(1) / dot(e, e);
    Value const along = Value(-2) * scale * dot(u, m0);
    return Value(Value(2) * scale) * multiply_add(along, e, u);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> move(Vec3<Value> const& f, Vec3<Value> const& m0) {
    Value const s = dot(f, f);
    return multiply_add(Value(Value(2) / (Value(1) + s)), multiply_add(Value(Value(0) - s), m0, f),
                        m0);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> finish(Vec3<Value> const& f,
                                                        Vec3<Value> const& m0) {
    return move(f, m0);
  }

  /// The f of move(f, m0) = m; made of m - m0, it loses nothing where that is small.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> coordinates(Vec3<Value> const& m,
                                                             Vec3<Value> const& m0) {
    Vec3<Value> const d = m - m0;
    Value const square = dot(d, d);
    Value const r = Value(2) / (Value(4) - square);
    return r * multiply_add(Value(Value(0.5) * square), m0, d);
  }

  /// move(increment(..), m0) in one, with one division.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> advance(Vec3<Value> const& step_times_a,
                                                         Vec3<Value> const& m,
                                                         Vec3<Value> const& m0) {
    Vec3<Value> const u = cross(step_times_a, m);
    Vec3<Value> const e = m + m0;
    Value const e2 = dot(e, e), u2 = dot(u, u);
    Vec3<Value> const t = multiply_add(Value(Value(-2) * dot(u, m0)), e, Vec3<Value>(e2 * u));
    Value const scale = Value(4) / detail::multiply_add(e2, e2, Value(Value(4) * u2));
    return multiply_add(scale, multiply_add(Value(Value(-2) * u2), m0, t), m0);
  }
};

}  // namespace cayspin::update
