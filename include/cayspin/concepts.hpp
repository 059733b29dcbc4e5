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

/// The linear part of an affine field at a stencil's centre, applied to the stencil's array.
template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> linear_field(
    Term const& term, Stencil const& stencil) {
  using Value = typename Stencil::value_type;
  if constexpr (requires { Term::degree; }) {
    static_assert(
        Term::degree == 1 || Term::degree == 2,
        "A field term's degree is that of its energy: 1 for H independent of the spins, 2 "
        "for H linear in them; leave it out otherwise.");
    if constexpr (Term::degree == 2)
      return term.field(stencil);
    else
      return {Value(0), Value(0), Value(0)};
  } else {
    static_assert(has_linear_field<Term, Stencil>,
                  "This needs the derivative of each field term: a static constexpr int degree (1 "
                  "for H independent of the spins, 2 for H linear in them), linear_field(stencil) "
                  "for H affine in them, or, for isotropy::Analytic alone, field_rate(m, rates).");
    return term.linear_field(stencil);
  }
}

/// The derivative of a field at a spin m, along the rates of the stencil's array.
template <class Term, class Value, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> field_rate(Term const& term, Vec3<Value> const& m,
                                                   Stencil const& rates) {
  if constexpr (has_field_rate<Term, Stencil>)
    return term.field_rate(m, rates);
  else
    return linear_field(term, rates);
}

/// Said by a term or generator whose numbers change with t, and not with the spins.
template <class Term>
inline constexpr bool depends_on_time = [] {
  if constexpr (requires { Term::depends_on_time; }) return Term::depends_on_time;
  return false;
}();

/// Is one prepared form good for any time and any spins? Of terms and generators that have a
/// prepare and do not say so: no.
template <class Term, class Exec, class Spins>
bool is_stationary(Term const& term, Exec const& exec, Spins const& spins) {
  if constexpr (requires { term.is_stationary(exec, spins); })
    return term.is_stationary(exec, spins);
  else
    return !requires { term.prepare(exec, spins, 0.0); };
}

/// Can one evaluation be made ready knowing t alone, before the spins it is for are there?
template <class Term, class Exec, class Spins>
bool needs_time_alone(Term const& term, Exec const& exec, Spins const& spins) {
  if constexpr (requires { term.needs_time_alone(exec, spins); })
    return term.needs_time_alone(exec, spins);
  else
    return depends_on_time<Term> || is_stationary(term, exec, spins);
}

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
