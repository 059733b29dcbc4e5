// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/vec3.hpp>

#include <concepts>

// How the library calls field terms and generators. Each function calls a member of the term or
// generator or, if there is none, uses the default, as in the tables of concepts.hpp.
// field/parts.hpp has the functions for a field made of several terms.
namespace cayspin::inline v0_2::detail {

template <class Term, class Stencil>
concept has_field = requires(Term const& term, Stencil const& stencil) {
  { term.field(stencil) } -> std::convertible_to<VectorOf<Stencil>>;
};

template <class Term, class Stencil>
concept has_energy_density = requires(Term const& term, Stencil const& stencil) {
  { term.energy_density(stencil) } -> std::convertible_to<ValueOf<Stencil>>;
};

template <class Generator, class Stencil>
concept is_generator = requires(Generator const& generator, Stencil const& stencil) {
  { generator(stencil) } -> std::convertible_to<VectorOf<Stencil>>;
};

/// Compile-time error messages for an invalid term.
template <class Term, class Stencil>
constexpr void check_field() {
  static_assert(has_field<Term, Stencil>,
                "A field term needs a const, device-callable template field(stencil) that "
                "returns Vec3<typename Stencil::value_type>, or a prepare(exec, spins, t) that "
                "returns such a term.");
}
template <class Source, class Stencil>
constexpr void check_energy_density() {
  static_assert(has_energy_density<Source, Stencil>,
                "A field term needs a const, device-callable template energy_density(stencil) "
                "that returns typename Stencil::value_type, with field = -d energy / d spin.");
}

/// True if H of a term, or of the field in a generator, is the derivative of an energy. Whether the
/// motion conserves that energy is a different question: see a generator's conserves_energy().
template <class Source>
inline constexpr bool is_conservative = !requires { requires !Source::is_conservative; };

/// Requires an energy, for algorithms that minimise or conserve it.
template <class Source>
constexpr void check_conservative() {
  static_assert(is_conservative<Source>,
                "This needs a field that is the derivative of an energy, without terms that say "
                "is_conservative = false, such as ZhangLi and Slonczewski.");
}

/// Returns `h` plus a term's field at a stencil's centre. Most terms need fewer operations for this
/// than for the field and a sum.
template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add_field(Term const& term, Stencil const& stencil,
                                                        VectorOf<Stencil> const& h) {
  check_field<Term, Stencil>();
  if constexpr (requires { term.add_field(stencil, h); })
    return term.add_field(stencil, h);
  else
    return h + term.field(stencil);
}

/// Returns `h` plus a term's field plus some multiple of the spin.
template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add_turning_field(Term const& term,
                                                                Stencil const& stencil,
                                                                VectorOf<Stencil> const& h) {
  if constexpr (requires { term.add_turning_field(stencil, h); })
    return term.add_turning_field(stencil, h);
  else
    return add_field(term, stencil, h);
}

template <class Term>
inline constexpr bool depends_on_time = requires { requires Term::depends_on_time; };

/// True for a local term: H at a site depends only on the spin of that site and t.
template <class Term>
inline constexpr bool is_local = requires { requires Term::is_local; };

/// Base class of terms whose prepared form is the same for all t and spins.
struct PreparedOnce {
  template <class Exec, class Spins>
  bool is_stationary(Exec const&, Spins const&) const {
    return true;
  }
};

template <class Term, class Exec, class Spins>
bool is_stationary(Term const& term, Exec const& exec, Spins const& spins) {
  if constexpr (requires { term.is_stationary(exec, spins); })
    return term.is_stationary(exec, spins);
  else
    return !requires { term.prepare(exec, spins, 0.0); };
}

template <class Term, class Exec, class Spins>
bool needs_only_time(Term const& term, Exec const& exec, Spins const& spins) {
  if constexpr (requires { term.needs_only_time(exec, spins); })
    return term.needs_only_time(exec, spins);
  // A term with both is_stationary and depends_on_time is made of other terms. Its depends_on_time
  // is true if that of one of them is: the others may still need the spins.
  else if constexpr (requires { term.is_stationary(exec, spins); })
    return term.is_stationary(exec, spins);
  else
    return depends_on_time<Term> || is_stationary(term, exec, spins);
}

/// Returns true if prepare_for_rows does not need the spins.
template <class Term, class Exec, class Spins>
bool rows_need_only_time(Term const& term, Exec const& exec, Spins const& spins) {
  if constexpr (requires { term.rows_need_only_time(exec, spins); })
    return term.rows_need_only_time(exec, spins);
  else
    return needs_only_time(term, exec, spins);
}

template <class Term, class Spins>
void check_spins(Term const& term, Spins const& spins) {
  if constexpr (requires { term.check_spins(spins); }) term.check_spins(spins);
}

/// Returns the kernel version of a term or generator for one evaluation at time t. Throws
/// std::invalid_argument when it was made for spins of another lattice.
template <class Term, class Exec, class Spins>
auto prepare_term(Term const& term, Exec const& exec, Spins const& spins, double t) {
  check_spins(term, spins);
  if constexpr (requires { term.prepare(exec, spins, t); }) {
    return term.prepare(exec, spins, t);
  } else {
    return term;
  }
}

/// Returns the kernel version for a host loop that calls begin_row (detail/row_fields.hpp); a term
/// may leave the work of prepare to begin_row.
template <class Term, class Exec, class Spins>
auto prepare_for_rows(Term const& term, Exec const& exec, Spins const& spins, double t) {
  if constexpr (requires { term.prepare_for_rows(exec, spins, t); }) {
    check_spins(term, spins);
    return term.prepare_for_rows(exec, spins, t);
  } else {
    return prepare_term(term, exec, spins, t);
  }
}

/// Returns true if H is affine in the spins. Terms for which this is known at compile time have a
/// member `degree`.
template <class Term, class Exec, class Spins>
bool has_affine_field(Term const& term, Exec const& exec, Spins const& spins) {
  auto const is = [&](auto const& part) { return has_affine_field(part, exec, spins); };
  if constexpr (requires { term.is_affine(); })
    return term.is_affine();
  else if constexpr (requires { term.all_parts(is); })
    return term.all_parts(is);
  else
    return requires { decltype(prepare_term(term, exec, spins, 0.0))::degree; };
}

/// Returns a generator's A at the centre of a stencil.
template <class Generator, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> evaluate(Generator const& generator,
                                                       Stencil const& stencil) {
  static_assert(is_generator<Generator, Stencil>,
                "A generator needs a const, device-callable template operator()(stencil) that "
                "returns Vec3<typename Stencil::value_type>: the A of m' = A x m.");
  return generator(stencil);
}

/// Returns A plus some multiple of the spin, which has no effect on the motion.
template <class Generator, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> turning_part(Generator const& generator,
                                                           Stencil const& stencil) {
  if constexpr (requires { generator.turning_part(stencil); })
    return generator.turning_part(stencil);
  else
    return evaluate(generator, stencil);
}

}  // namespace cayspin::inline v0_2::detail
