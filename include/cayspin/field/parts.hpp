// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/unrolled.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/vec3.hpp>

#include <concepts>
#include <cstddef>
#include <utility>

// A field made of other terms, as kernels see it. It has
//   gather(take, stencil)    the weighted sum over its parts of take(part, stencil),
// where `take` is one of the structs below and says which quantity of each part is wanted.
// Optional:
//   energy_terms, energy_densities(stencil, energies)    number of terms; energy of each
//   energy_magnitude(stencil)    sum of absolute energies; default: over these terms
//   local_field_varies()         true if the local part of H changes with the spin
// The local part of H at a site depends only on the spin of that site and t; the rest is the
// neighbour field. RedBlack uses each of the two separately.
namespace cayspin::inline v0_2::detail {

/// Type list of the parts of a term or generator. It is empty unless the term derives from
/// Forwarding or defines parts_of.
template <class... Parts>
struct PartsOf {};
PartsOf<> parts_of(void const*);

template <class Term>
using PartsOfTerm = decltype(parts_of(std::declval<Term const*>()));

template <template <class> class Wanted, class Term>
inline constexpr bool is_a = false;
template <template <class> class Wanted, class Argument>
inline constexpr bool is_a<Wanted, Wanted<Argument>> = true;

/// True if a term, or a part of it at any depth, is a Wanted<..>.
template <template <class> class Wanted, class Term>
constexpr bool holds();
template <template <class> class Wanted, class... Parts>
constexpr bool any_holds(PartsOf<Parts...>) {
  return (holds<Wanted, Parts>() || ...);
}
template <template <class> class Wanted, class Term>
constexpr bool holds() {
  return is_a<Wanted, Term> || any_holds<Wanted>(PartsOfTerm<Term>());
}

template <class Take, class Term, class Stencil>
concept gathers = requires(Take const& take, Term const& term, Stencil const& stencil) {
  { term.gather(take, stencil) } -> std::convertible_to<VectorOf<Stencil>>;
};

template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> turning_field(Term const& term,
                                                            Stencil const& stencil);
template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Term const& term,
                                                             Stencil const& stencil);
template <class Term, class Spin>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Spin> local_field(Term const& term, Spin const& spin);

template <class Term>
constexpr bool has_local_part();
template <class... Parts>
constexpr bool any_has_local_part(PartsOf<Parts...>) {
  return (has_local_part<Parts>() || ...);
}
template <class Term>
constexpr bool has_local_part() {
  return is_local<Term> || any_has_local_part(PartsOfTerm<Term>());
}

// These structs select a quantity of each part. `add` returns `h` plus the quantity of one part.
// `skips` is true for parts whose quantity is zero.

struct WholeField {
  template <class Term>
  static constexpr bool skips = false;

  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> operator()(Term const& term,
                                                           Stencil const& stencil) const {
    check_field<Term, Stencil>();
    check_energy_density<Term, Stencil>();
    return term.field(stencil);
  }
  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add(Term const& term, Stencil const& stencil,
                                                    VectorOf<Stencil> const& h) const {
    check_energy_density<Term, Stencil>();
    return add_field(term, stencil, h);
  }
};

/// H up to a multiple of the spin.
struct TurningField {
  template <class Term>
  static constexpr bool skips = false;

  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> operator()(Term const& term,
                                                           Stencil const& stencil) const {
    check_field<Term, Stencil>();
    check_energy_density<Term, Stencil>();
    return turning_field(term, stencil);
  }
  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add(Term const& term, Stencil const& stencil,
                                                    VectorOf<Stencil> const& h) const {
    check_energy_density<Term, Stencil>();
    return add_turning_field(term, stencil, h);
  }
};

/// The neighbour field: the part of H that other spins determine, up to a multiple of the spin.
struct NeighborField {
  template <class Term>
  static constexpr bool skips = is_local<Term>;

  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> operator()(Term const& term,
                                                           Stencil const& stencil) const {
    return neighbor_field(term, stencil);
  }
  template <class Term, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add(Term const& term, Stencil const& stencil,
                                                    VectorOf<Stencil> const& h) const {
    return neighbor_field(term, stencil) + h;
  }
};

/// The local part of H.
struct LocalField {
  template <class Term>
  static constexpr bool skips = !has_local_part<Term>();

  template <class Term, class Spin>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Spin> operator()(Term const& term, Spin const& spin) const {
    return local_field(term, spin);
  }
  template <class Term, class Spin>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Spin> add(Term const& term, Spin const& spin,
                                                 VectorOf<Spin> const& h) const {
    return local_field(term, spin) + h;
  }
};

template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> turning_field(Term const& term,
                                                            Stencil const& stencil) {
  if constexpr (gathers<TurningField, Term, Stencil>)
    return term.gather(TurningField(), stencil);
  else if constexpr (requires { term.add_turning_field(stencil, stencil.center()); })
    return term.add_turning_field(stencil, zero<ValueOf<Stencil>>());
  else
    return term.field(stencil);
}

template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Term const& term,
                                                             Stencil const& stencil) {
  if constexpr (is_local<Term>)
    return zero<ValueOf<Stencil>>();
  else if constexpr (gathers<NeighborField, Term, Stencil>)
    return term.gather(NeighborField(), stencil);
  else
    return term.neighbor_field(stencil);
}

template <class Term, class Spin>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Spin> local_field(Term const& term, Spin const& spin) {
  if constexpr (gathers<LocalField, Term, Spin>)
    return term.gather(LocalField(), spin);
  else if constexpr (is_local<Term>)
    return term.field(spin);
  else
    return zero<ValueOf<Spin>>();
}

/// True if a prepared term splits H into a neighbour field and a local part.
template <class Term, class Stencil>
constexpr bool comes_in_parts();
template <class Stencil, class... Parts>
constexpr bool all_come_in_parts(PartsOf<Parts...>) {
  return (comes_in_parts<Parts, Stencil>() && ...);
}
template <class Term, class Stencil>
constexpr bool comes_in_parts() {
  if constexpr (gathers<NeighborField, Term, Stencil>)
    return all_come_in_parts<Stencil>(PartsOfTerm<Term>());
  else
    return is_local<Term> ||
           requires(Term const& term, Stencil const& stencil) { term.neighbor_field(stencil); };
}

template <class Term>
KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies(Term const& term) {
  if constexpr (requires { term.local_field_varies(); })
    return term.local_field_varies();
  else if constexpr (requires { requires Term::degree == 1; })
    return false;
  else
    return is_local<Term>;
}

/// Number of terms summed in the energy of a term or generator.
template <class Source>
inline constexpr int energy_terms = [] {
  if constexpr (requires { Source::energy_terms; }) return Source::energy_terms;
  return 1;
}();

/// Writes the energy density of each term that is summed in the energy of `source`.
template <class Source, class Stencil, class Value>
KOKKOS_FORCEINLINE_FUNCTION void energy_densities(Source const& source, Stencil const& stencil,
                                                  Value* energies) {
  if constexpr (requires { source.energy_densities(stencil, energies); }) {
    source.energy_densities(stencil, energies);
  } else {
    check_energy_density<Source, Stencil>();
    energies[0] = source.energy_density(stencil);
  }
}

/// Returns the sum of the absolute energy densities of the terms of `source`.
template <class Source, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_magnitude(Source const& source,
                                                              Stencil const& stencil) {
  using Value = ValueOf<Stencil>;
  constexpr int terms = energy_terms<Source>;
  if constexpr (requires { source.energy_magnitude(stencil); }) {
    return source.energy_magnitude(stencil);
  } else if constexpr (terms == 0) {
    return Value(0);
  } else {
    Value energies[std::size_t{terms}];
    energy_densities(source, stencil, energies);
    Value sum = Kokkos::abs(energies[terms - 1]);
    unrolled<terms - 1>([&](auto i) { sum = Kokkos::abs(energies[terms - 2 - i()]) + sum; });
    return sum;
  }
}

}  // namespace cayspin::inline v0_2::detail
