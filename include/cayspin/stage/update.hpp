// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/quotient.hpp>
#include <cayspin/detail/unrolled.hpp>
#include <cayspin/rotation/displacement.hpp>
#include <cayspin/vec3.hpp>

#include <cstddef>
#include <type_traits>

// The geometry of a Runge-Kutta method: how the generator A of a stage gives an increment, and how
// coordinates f, which are weighted sums of increments, move a spin from m0, the spin at the start
// of the step. increment(f, dt * A, m, m0) is the increment of a stage at the spin m, which is m0
// moved by f. `move` is for stages and `finish` is for the end of the step; displacement(f, m0) is
// the change of the spin, finish(f, m0) - m0. In a chain of stages, each stage uses only the
// increment of the stage before it. recovers_increments(stages) is true if a chain of this length
// does not store increments: the last stage recomputes each of them from the spin to which it moved
// m0. Where `increment` does not use f, comments omit this argument.
namespace cayspin::inline v0_2::update {

/// Runge-Kutta-Munthe-Kaas: f is in the Lie algebra, with m = Rotation(f) m0 and f' =
/// dRotation_f^-1 (A).
template <class Rotation>
struct Lie {
  static constexpr bool increment_needs_argument = true;

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> increment(Vec3<Value> const& f,
                                                           Vec3<Value> const& step_times_a,
                                                           Vec3<Value> const&, Vec3<Value> const&) {
    return Rotation::inverse_differential(f, step_times_a);
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
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Displacement<Value> displacement(Vec3<Value> const& f,
                                                                      Vec3<Value> const& m0) {
    return Rotation::displacement(f, m0);
  }
};

/// Like Lie, but without the inverse differential: the increments are dt * A. Methods of order 1
/// and 2 keep their order. Lewis and Nigam 2002, Sec. 4.3.
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

/// Classical Runge-Kutta in Cartesian components: f is a displacement, and |m| drifts.
struct Classical {
  static constexpr bool increment_needs_argument = false;
  static constexpr bool needs_turning_alone =
      true;  // only the part of A normal to m matters, because increments are dt * A x m

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
    return m0 + f;
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Displacement<Value> displacement(Vec3<Value> const& f,
                                                                      Vec3<Value> const&) {
    return {Value(1), f};
  }
};

/// Classical, with each spin divided by its length at the end of the step, as in most spin codes.
/// Chains of up to four stages, such as RK4, store increments; longer ones recompute them from the
/// spins.
struct Projected : Classical {
  static constexpr bool recovers_increments(int stages) { return stages > 4; }

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> finish(Vec3<Value> const& f,
                                                        Vec3<Value> const& m0) {
    Vec3<Value> const m = m0 + f;
    return Value(Value(1) / detail::square_root<Value>(detail::square_to_divide_by(m))) * m;
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Displacement<Value> displacement(Vec3<Value> const& f,
                                                                      Vec3<Value> const& m0) {
    Value const longer = dot(f, f) + Value(2) * dot(f, m0);  // |m0 + f|^2 - |m0|^2
    Value const length = detail::square_root<Value>(Value(1) + longer);
    Value const along = longer / (Value(1) + length);  // |m0 + f| - 1 for a unit m0
    return {Value(1) / length, multiply_add(Value(Value(0) - along), m0, f)};
  }

  /// Returns move(increment(step * a, m, m), m).
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> advance(Value const& step, Vec3<Value> const& a,
                                                         Vec3<Value> const& m) {
    return advance(step, a, m, m);
  }

  /// Returns move(increment(step * a, m, m0), m0).
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> advance(Value const& step, Vec3<Value> const& a,
                                                         Vec3<Value> const& m,
                                                         Vec3<Value> const& m0) {
    return multiply_add(step, cross(a, m), m0);
  }

  /// Returns finish(f, m0) with
  /// f = sum_j Weights::spin(j) * f_j + Weights::last * increment(step * a, m, m0),
  /// where f_j moves m0 to spins[j] and m is the last of Count spins.
  template <class Weights, int Count, class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> arrive(Value const& step, Vec3<Value> const& a,
                                                        Vec3<Value> const* spins,
                                                        Vec3<Value> const& m0) {
    using Scalar = detail::scalar_t<Value>;
    Vec3<Value> f = Value(Value(static_cast<Scalar>(Weights::last)) * step) *
                    cross(a, spins[std::size_t{Count - 1}]);
    detail::unrolled<Count>([&](auto j) {
      constexpr double weight = Weights::spin(j());
      if constexpr (weight != 0)
        f = multiply_add(Value(static_cast<Scalar>(weight)), Vec3<Value>(spins[j()] - m0), f);
    });
    return finish(f, m0);
  }
};

/// Classical Runge-Kutta in the stereographic chart at m0: f is normal to m0 and stands for the
/// rotation cay(2 * m0 x f). The coordinates of every stage stay normal to m0. Not in Lewis and
/// Nigam 2002. Breaks down only if the spin of a stage reaches -m0.
struct Stereographic {
  static constexpr bool increment_needs_argument = false;
  static constexpr bool needs_turning_alone = true;
  static constexpr bool recovers_increments(int stages) { return stages > 1; }

  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> increment(Vec3<Value> const&,
                                                           Vec3<Value> const& step_times_a,
                                                           Vec3<Value> const& m,
                                                           Vec3<Value> const& m0) {
    Vec3<Value> const u = cross(step_times_a, m);
    Vec3<Value> const e = m + m0;
    Value const scale = detail::quotient(Value(1), detail::square_to_divide_by(e));
    Value const along = Value(-2) * scale * dot(u, m0);
    return Value(Value(2) * scale) * multiply_add(along, e, u);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> move(Vec3<Value> const& f, Vec3<Value> const& m0) {
    return displacement(f, m0).from(m0);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> finish(Vec3<Value> const& f,
                                                        Vec3<Value> const& m0) {
    return move(f, m0);
  }
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Displacement<Value> displacement(Vec3<Value> const& f,
                                                                      Vec3<Value> const& m0) {
    Value const s = dot(f, f);
    return {detail::quotient(Value(2), Value(Value(1) + s)),
            multiply_add(Value(Value(0) - s), m0, f)};
  }

  /// Returns move(increment(step * a, m, m), m) for a unit spin, with one division.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> advance(Value const& step, Vec3<Value> const& a,
                                                         Vec3<Value> const& m) {
    Vec3<Value> const u = cross(a, m);
    Value const s = Value(Value(0.25) * step * step) * dot(u, u);
    Value const scale = detail::quotient(Value(1), Value(Value(1) + s));
    return multiply_add(Value(scale * step), u, multiply_add(Value(Value(-2) * scale * s), m, m));
  }

  /// Returns move(increment(step * a, m, m0), m0) for unit spins, with one division.
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> advance(Value const& step, Vec3<Value> const& a,
                                                         Vec3<Value> const& m,
                                                         Vec3<Value> const& m0) {
    Vec3<Value> const u = cross(a, m);
    Value const e2 = detail::multiply_add(Value(2), dot(m, m0), Value(2));  // |m + m0|^2
    Value const reach = step * dot(u, u), step4 = Value(4) * step;
    Value const scale = detail::quotient(step4, detail::multiply_add(e2, e2, Value(step4 * reach)));
    Value const minus = Value(-2) * scale, along = minus * dot(u, m0);
    return multiply_add(
        along, m,
        multiply_add(Value(scale * e2), u,
                     multiply_add(detail::multiply_add(minus, reach, along), m0, m0)));
  }

  /// Returns move(f, m0) with
  /// f = sum_j Weights::spin(j) * f_j + Weights::last * increment(step * a, m, m0),
  /// where f_j moves m0 to spins[j] and m is the last of Count spins. Takes one division. The spins
  /// enter as differences from m0, so that small steps keep their relative precision.
  template <class Weights, int Count, class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Vec3<Value> arrive(Value const& step, Vec3<Value> const& a,
                                                        Vec3<Value> const* spins,
                                                        Vec3<Value> const& m0) {
    using Scalar = detail::scalar_t<Value>;
    constexpr int own = Count - 1;
    Vec3<Value> d[std::size_t{Count}];
    // `square` is |d|^2, and `rest` is 4 - |d|^2. With them, f_j = (2 d + |d|^2 m0) / rest.
    Value square[std::size_t{Count}], rest[std::size_t{Count}];
    Value others(1);  // product of the elements of `rest` that are set, except that of m
    detail::unrolled<Count>([&](auto j) {
      if constexpr (j() < own && Weights::spin(j()) == 0) return;
      d[j()] = spins[j()] - m0;
      square[j()] = dot(d[j()], d[j()]);
      rest[j()] = Value(4) - square[j()];
      if constexpr (j() < own) others = others * rest[j()];
    });
    Value const e2 = rest[own];  // |m + m0|^2
    Value const e4 = e2 * e2, denominator = others * e4;

    Vec3<Value> const u = cross(a, spins[own]);
    Value const doubled = Value(static_cast<Scalar>(2 * Weights::last)) * step * others;
    Value const along = Value(-2) * doubled * dot(u, m0);
    Value const of_own = Value(static_cast<Scalar>(Weights::spin(own))) * others * e2;
    Value of_start = detail::multiply_add(of_own, square[own], Value(along + along));
    Vec3<Value> f = multiply_add(detail::multiply_add(Value(2), of_own, along), d[own],
                                 Vec3<Value>(Value(doubled * e2) * u));
    detail::unrolled<own>([&](auto j) {
      constexpr double weight = Weights::spin(j());
      if constexpr (weight != 0) {
        Value factor = Value(static_cast<Scalar>(weight)) * e4;
        detail::unrolled<own>([&](auto other) {
          if constexpr (other() != j() && Weights::spin(other()) != 0)
            factor = factor * rest[other()];
        });
        of_start = detail::multiply_add(factor, square[j()], of_start);
        f = multiply_add(Value(factor + factor), d[j()], f);
      }
    });
    f = multiply_add(of_start, m0, f);

    Value const s = dot(f, f);
    Value const scale =
        detail::quotient(Value(2), detail::multiply_add(denominator, denominator, s));
    return multiply_add(Value(scale * denominator), f,
                        multiply_add(Value(Value(0) - scale * s), m0, m0));
  }
};

}  // namespace cayspin::inline v0_2::update
