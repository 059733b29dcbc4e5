// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

#include <concepts>

namespace cayspin::detail {

template <class Term, class Stencil>
concept has_field = requires(Term const& term, Stencil const& stencil) {
  { term.field(stencil) } -> std::convertible_to<Vec3<typename Stencil::value_type>>;
};

template <class Term, class Stencil>
concept has_energy_density = requires(Term const& term, Stencil const& stencil) {
  { term.energy_density(stencil) } -> std::convertible_to<typename Stencil::value_type>;
};

template <class Term, class Stencil>
concept has_linear_field = requires(Term const& term, Stencil const& stencil) {
  { term.linear_field(stencil) } -> std::convertible_to<Vec3<typename Stencil::value_type>>;
};

template <class Term, class Stencil>
concept has_field_rate = requires(Term const& term, Stencil const& stencil) {
  {
    term.field_rate(stencil.center(), stencil)
    } -> std::convertible_to<Vec3<typename Stencil::value_type>>;
};

/// Said by a term or generator whose numbers change with t alone.
template <class Term>
inline constexpr bool depends_on_time = [] {
  if constexpr (requires { Term::depends_on_time; }) return Term::depends_on_time;
  return false;
}();

/// The device-callable form of a term or generator for one evaluation at time t: what its
/// prepare returns, or itself.
template <class Term, class Exec, class Spins>
auto prepare_term(Term const& term, Exec const& exec, Spins const& spins, double t) {
  if constexpr (requires { term.prepare(exec, spins, t); }) {
    return term.prepare(exec, spins, t);
  } else {
    return term;
  }
}

/// The same for the derivative of a term or generator along `rates`, the X = A x m of every spin.
template <class Term, class Exec, class Spins>
auto prepare_rate(Term const& term, Exec const& exec, Spins const& rates, double t, double dt) {
  if constexpr (requires { term.prepare_rate(exec, rates, t, dt); }) {
    return term.prepare_rate(exec, rates, t, dt);
  } else {
    return prepare_term(term, exec, rates, t);
  }
}

/// A generator's A at the centre of a stencil.
template <class Generator, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> evaluate(Generator const& generator,
                                                                        Stencil const& stencil) {
  static_assert(
      requires {
        { generator(stencil) } -> std::convertible_to<Vec3<typename Stencil::value_type>>;
      },
      "A generator needs a const, device-callable template operator()(stencil) that returns "
      "Vec3<typename Stencil::value_type>: the A of m' = A x m.");
  return generator(stencil);
}

}  // namespace cayspin::detail
