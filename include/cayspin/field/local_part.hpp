// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/optional_members.hpp>
#include <cayspin/vec3.hpp>

// A field in two parts: the local part at a site depends on the spin there and on t alone, the rest
// is the neighbour field. For RedBlack, which moves each spin in the field of its neighbours. The
// members are listed in concepts.hpp.
namespace cayspin::inline v0_1::detail {

/// Does a prepared term split its field into a local and a neighbour part?
template <class Term, class Stencil>
inline constexpr bool comes_in_parts =
    is_local<Term> ||
    requires(Term const& term, Stencil const& stencil) { term.neighbor_field(stencil); };

/// The neighbour field at a stencil's centre, of a prepared term that comes in parts.
template <class Term, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Term const& term,
                                                             Stencil const& stencil) {
  if constexpr (is_local<Term>)
    return zero<ValueOf<Stencil>>();
  else
    return term.neighbor_field(stencil);
}

/// The rest of such a term's H.
template <class Term, class Spin>
KOKKOS_FORCEINLINE_FUNCTION VectorOf<Spin> local_field(Term const& term, Spin const& spin) {
  if constexpr (requires { term.local_field(spin); })
    return term.local_field(spin);
  else if constexpr (is_local<Term>)
    return term.field(spin);
  else
    return zero<ValueOf<Spin>>();
}

/// Does the local field of such a term change with the spin?
template <class Term>
KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies(Term const& term) {
  if constexpr (requires { term.local_field_varies(); })
    return term.local_field_varies();
  else if constexpr (requires { requires Term::degree == 1; })
    return false;
  else
    return true;
}

}  // namespace cayspin::inline v0_1::detail
