// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

#include <type_traits>

// How an increment moves a spin, and which increment a generator gives at a stage: the part of a
// Runge-Kutta method that is geometry. Coordinates f are taken at the spin m0 of the step's begin.
namespace cayspin::update {

/// Runge-Kutta-Munthe-Kaas: f in the Lie algebra, m = Rotation(f) m0, f' = dRotation_f^-1 (A).
template <class Rotation>
struct Lie {
  static constexpr bool increment_needs_argument = true;
  static constexpr bool keeps_generators = false;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> increment(Vec3<Value> const& f,
                                                           Vec3<Value> const& step_times_a,
                                                           Vec3<Value> const&) {
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
                                                           Vec3<Value> const& m) {
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

}  // namespace cayspin::update
