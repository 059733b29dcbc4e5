// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/cubic_anisotropy.hpp>
#include <cayspin/field/effective_field.hpp>
#include <cayspin/field/host_field.hpp>
#include <cayspin/field/pair_couplings.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/field/slonczewski.hpp>
#include <cayspin/field/slow_field.hpp>
#include <cayspin/field/zeeman.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stencil.hpp>

#include <concepts>
#include <stdexcept>

// Derivatives of the effective field, for Series4, isotropy::Analytic and isotropy::Connection.
// Those of the library's terms are defined below. A user's term needs one of
//   static constexpr int degree           see FieldTerm in cayspin/concepts.hpp
//   Vec3<Value> linear_field(stencil)     the linear part of an H that is affine in the spins;
//                                         requires is_affine()
//   Vec3<Value> field_rate(m, rates)      not for Series4: dH/dt at m, along the rates of the
//                                         stencil's array
// and, if prepare is not enough,
//   auto prepare_rate(exec, rates, t, dt)     returns the term for kernels that evaluate dH/dt at
//                                             time t
namespace cayspin::inline v0_2::detail {

/// The contribution of a uniform applied field to dH/dt, as a term.
struct AppliedRate {
  Vec3<double> rate;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> linear_field(Stencil const&) const {
    return as_value<ValueOf<Stencil>>(rate);
  }
};

/// Returns the time derivative of a callable by central differences of order 4, from its values at
/// t +- dt/8 and t +- dt/4, where it must be defined. If the values oscillate with the angular
/// frequency w, the relative error is about (w * dt)^4 / 1e5.
template <class Applied>
Vec3<double> time_derivative(Applied const& applied, double t, double dt) {
  if (dt == 0) return {0, 0, 0};  // in a step of zero length no spin moves
  double const d = dt / 8;
  Vec3<double> const near = applied(t + d) - applied(t - d);
  Vec3<double> const far = applied(t + 2 * d) - applied(t - 2 * d);
  return (1 / (12 * d)) * (8.0 * near - far);
}

// Library terms whose derivative does not follow from the degree.

template <class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> linear_part(Slonczewski const& term,
                                                          Stencil const& stencil) {
  return term.damping_like_field(stencil);
}
template <class Real, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> linear_part(StoredField<Real> const& term,
                                                          Stencil const& stencil) {
  return term.energy_factor == -0.5 ? term.field(stencil) : zero<ValueOf<Stencil>>();
}
/// Linear part of couplings; a biquadratic part is omitted.
template <class Real, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> linear_part(PairField<Real> const& term,
                                                          Stencil const& stencil) {
  return term.parts(stencil).linear;
}

template <class Value, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> rate_of_field(CubicAnisotropy const& term,
                                                      Vec3<Value> const& spin,
                                                      Stencil const& rates) {
  Vec3<Value> const m = term.parts(spin), rate = term.parts(rates.center());
  Vec3<Value> const half{m.x * rate.x, m.y * rate.y,
                         m.z * rate.z};  // half the rates of the squares
  Value const a = m.x * m.x, b = m.y * m.y, c = m.z * m.z;
  Vec3<Value> const changes{rate.x * (b + c) + Value(2) * m.x * (half.y + half.z),
                            rate.y * (c + a) + Value(2) * m.y * (half.z + half.x),
                            rate.z * (a + b) + Value(2) * m.z * (half.x + half.y)};
  return as_value<Value>(-2 * term.constant()) * term.sum(changes);
}

template <class Applied, class Exec, class Spins>
AppliedRate prepared_rate(TimeDependentZeeman<Applied> const& term, Exec const&, Spins const&,
                          double t, double dt) {
  return {time_derivative(term.applied(), t, dt)};
}
/// Throws std::invalid_argument for biquadratic couplings: their derivative depends on the spins,
/// not only on the rates.
template <class MemorySpace, class Exec, class Spins>
auto prepared_rate(PairCouplings<MemorySpace> const& term, Exec const& exec, Spins const& rates,
                   double t, double) {
  if (term.has_biquadratic())
    throw std::invalid_argument(
        "cayspin::PairCouplings: biquadratic couplings have no derivative along rates only");
  return term.prepare(exec, rates, t);
}
/// Throws std::logic_error while the field is interpolated between evaluations.
template <class Term, class Exec, class Spins>
auto prepared_rate(SlowField<Spins, Term> const& term, Exec const& exec, Spins const& rates,
                   double t, double) {
  static_assert(!depends_on_time<Term>, "An expensive field that depends on t has no rate.");
  if (term.is_interpolated())
    throw std::logic_error("cayspin::SlowField: an interpolated field has no rate");
  return term.prepare(exec, rates, t);
}

/// Functor that applies the linear part of an affine field to the stencil's array, and returns the
/// result at the stencil's centre.
struct LinearField {
  template <class Term>
  static constexpr bool skips = false;

  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> operator()(Term const& term,
                                                           Stencil const& stencil) const {
    if constexpr (gathers<LinearField, Term, Stencil>) {
      return term.gather(*this, stencil);
    } else if constexpr (requires { term.linear_field(stencil); }) {
      return term.linear_field(stencil);
    } else if constexpr (requires { linear_part(term, stencil); }) {
      return linear_part(term, stencil);
    } else {
      static_assert(
          requires { requires Term::degree == 1 || Term::degree == 2; },
          "This needs the derivative of each field term: a static constexpr int degree (1 for H "
          "independent of the spins, 2 for H linear in them), linear_field(stencil) for H affine "
          "in them, or, only for isotropy::Analytic, field_rate(m, rates).");
      if constexpr (Term::degree == 2)
        return term.field(stencil);
      else
        return zero<ValueOf<Stencil>>();
    }
  }
  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add(Term const& term, Stencil const& stencil,
                                                    VectorOf<Stencil> const& h) const {
    return (*this)(term, stencil) + h;
  }
};

/// Functor that computes the derivative of a field at a spin m, along the rates of the stencil's
/// array.
template <class Value>
struct FieldRate {
  Vec3<Value> m;
  template <class Term>
  static constexpr bool skips = false;

  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Term const& term, Stencil const& rates) const {
    if constexpr (gathers<FieldRate, Term, Stencil>)
      return term.gather(*this, rates);
    else if constexpr (requires { term.field_rate(m, rates); })
      return term.field_rate(m, rates);
    else if constexpr (requires { rate_of_field(term, m, rates); })
      return rate_of_field(term, m, rates);
    else
      return LinearField()(term, rates);
  }
  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> add(Term const& term, Stencil const& rates,
                                              Vec3<Value> const& h) const {
    return (*this)(term, rates) + h;
  }
};

/// Returns the kernel version of a term or generator for its derivative along `rates`, the X = A x
/// m of every spin.
template <class Term, class Exec, class Spins>
auto prepare_rate(Term const& term, Exec const& exec, Spins const& rates, double t, double dt) {
  auto const of_part = [&](auto const& part) { return prepare_rate(part, exec, rates, t, dt); };
  check_spins(term, rates);
  if constexpr (requires { term.prepare_rate(exec, rates, t, dt); })
    return term.prepare_rate(exec, rates, t, dt);
  else if constexpr (requires { prepared_rate(term, exec, rates, t, dt); })
    return prepared_rate(term, exec, rates, t, dt);
  else if constexpr (requires { term.with_parts(of_part); })
    return term.with_parts(of_part);
  else
    return prepare_term(term, exec, rates, t);
}

/// has_linear_part is true if kernels can evaluate the linear part of a prepared field H;
/// has_derivative is true if they can evaluate the derivative of H along rates.
template <class Term, class Stencil>
constexpr bool has_linear_part();
template <class Term, class Stencil>
constexpr bool has_derivative();
template <class Stencil, class... Parts>
constexpr bool all_have_linear_part(PartsOf<Parts...>) {
  return (has_linear_part<Parts, Stencil>() && ...);
}
template <class Stencil, class... Parts>
constexpr bool all_have_derivative(PartsOf<Parts...>) {
  return (has_derivative<Parts, Stencil>() && ...);
}
template <class Term, class Stencil>
constexpr bool has_linear_part() {
  if constexpr (gathers<LinearField, Term, Stencil>)
    return all_have_linear_part<Stencil>(PartsOfTerm<Term>());
  else
    return requires(Term const& term, Stencil const& stencil) { term.linear_field(stencil); } ||
           requires(Term const& term, Stencil const& stencil) { linear_part(term, stencil); } ||
           requires { Term::degree; };
}
template <class Term, class Stencil>
constexpr bool has_derivative() {
  using Value = ValueOf<Stencil>;
  if constexpr (gathers<FieldRate<Value>, Term, Stencil>)
    return all_have_derivative<Stencil>(PartsOfTerm<Term>());
  else
    return requires(Term const& term, Vec3<Value> const& m, Stencil const& rates) {
      term.field_rate(m, rates);
    } || requires(Term const& term, Vec3<Value> const& m, Stencil const& rates) {
      rate_of_field(term, m, rates);
    } || has_linear_part<Term, Stencil>();
}

}  // namespace cayspin::inline v0_2::detail
