// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/optional_members.hpp>
#include <cayspin/vec3.hpp>

#include <concepts>
#include <type_traits>

// A field in two parts: the local part at a site depends on the spin there and on t alone, the rest
// is the neighbour field. For methods that move each spin in the field of the others. A term that
// says nothing is neighbour field altogether; the members are listed in concepts.hpp.
namespace cayspin::inline v0_1::detail {

/// The local part of what has none.
struct NoField {
  static constexpr bool is_local = true;
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const&) const {
    return zero<ValueOf<Stencil>>();
  }
};

/// The device-callable form of a term's or generator's local part at time t.
template <class Term, class Exec, class Spins>
auto prepare_local(Term const& term, Exec const& exec, Spins const& spins, double t) {
  if constexpr (requires { term.prepare_local(exec, spins, t); }) {
    check_spins(term, spins);
    return term.prepare_local(exec, spins, t);
  } else if constexpr (is_local<Term>) {
    return prepare_term(term, exec, spins, t);
  } else {
    return NoField{};
  }
}

/// A prepared term's neighbour field at a stencil's centre.
template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Term const& term,
                                                             Stencil const& stencil) {
  if constexpr (is_local<Term>)
    return zero<ValueOf<Stencil>>();
  else if constexpr (requires { term.neighbor_field(stencil); })
    return term.neighbor_field(stencil);
  else
    return term.field(stencil);
}

/// H of what prepare_local returned, and of a prepared term that comes in parts.
template <class Term, class Spin>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Spin> local_field(Term const& term, Spin const& spin) {
  if constexpr (requires { term.local_field(spin); })
    return term.local_field(spin);
  else if constexpr (is_local<Term>)
    return term.field(spin);
  else
    return zero<ValueOf<Spin>>();
}

/// Does a prepared term split its field into a local and a neighbour part?
template <class Term, class Stencil>
inline constexpr bool says_its_parts =
    is_local<Term> ||
    requires(Term const& term, Stencil const& stencil) { term.neighbor_field(stencil); };
/// Does each term of a prepared sum do so?
template <class Term, class Stencil>
inline constexpr bool comes_in_parts = says_its_parts<Term, Stencil>;

/// Of a prepared term that comes in parts: does its local field change with the spin?
template <class Term>
KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies(Term const& term) {
  if constexpr (requires { term.local_field_varies(); })
    return term.local_field_varies();
  else if constexpr (requires { requires Term::degree == 1; })
    return false;
  else
    return true;
}

/// A generator's A of a spin in a given neighbour field, by what its prepare_local returned.
template <class Generator, class Spin, class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> generator_at(Generator const& generator, Spin const& spin,
                                                     Vec3<Value> const& neighbor_field) {
  if constexpr (is_local<Generator> && !std::is_same_v<Generator, NoField>) {
    return evaluate(generator, spin);
  } else {
    static_assert(
        requires {
          { generator.generator_at(spin, neighbor_field) } -> std::convertible_to<Vec3<Value>>;
        },
        "Field extrapolation needs a generator that is made of a field: const, device-callable "
        "templates neighbor_field(stencil) and generator_at(spin, neighbor_field), and a "
        "prepare_local(exec, spins, t); or static constexpr bool is_local = true.");
    return generator.generator_at(spin, neighbor_field);
  }
}

/// The same of the neighbour field that a prepared generator is made of.
template <class Generator, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field_of(Generator const& generator,
                                                                Stencil const& stencil) {
  if constexpr (requires { generator.neighbor_field(stencil); })
    return generator.neighbor_field(stencil);
  else
    return zero<ValueOf<Stencil>>();  // generator_at says what is wrong
}

}  // namespace cayspin::inline v0_1::detail
