// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/field.hpp"

#include <cayspin/cayspin.hpp>

#include <tuple>

namespace cayspin::simulation {

/// Lattice terms for kernels, each enabled at run time if the scene has it.
template <class... Terms>
struct TermsIfThere {
  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_field(Stencil const&, Vector const& h) const {
    return h;
  }
  KOKKOS_FORCEINLINE_FUNCTION bool any() const { return false; }
  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_neighbor_field(Stencil const&, Vector const& h) const {
    return h;
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value add_energy_density(Stencil const&, Value const& e) const {
    return e;
  }
};
template <class Term, class... Others>
struct TermsIfThere<Term, Others...> {
  Term term;
  bool there;
  TermsIfThere<Others...> others;

  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_field(Stencil const& stencil, Vector const& h) const {
    return others.add_field(stencil, there ? cayspin::detail::add_field(term, stencil, h) : h);
  }
  KOKKOS_FORCEINLINE_FUNCTION bool any() const { return there || others.any(); }
  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_neighbor_field(Stencil const& stencil,
                                                        Vector const& h) const {
    return others.add_neighbor_field(
        stencil, there ? Vector(h + cayspin::detail::neighbor_field(term, stencil)) : h);
  }
  template <class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value add_energy_density(Stencil const& stencil,
                                                       Value const& e) const {
    return others.add_energy_density(stencil, there ? Value(e + term.energy_density(stencil)) : e);
  }
};

/// All lattice terms of io::Field. The first one, exchange, is evaluated in every scene.
template <class First, class... Others>
struct LatticeTerms {
  First first;
  TermsIfThere<Others...> others;
  double magnitude;  // of a site's energy: round-off is proportional to it

  bool couples_along_x() const { return first.couples_along_x() || others.any(); }

  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_field(Stencil const& stencil, Vector const& h) const {
    auto const sum = cayspin::detail::add_field(first, stencil, h);
    if (others.any()) [[unlikely]]
      return others.add_field(stencil, sum);
    return sum;
  }
  template <class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector add_turning_field(Stencil const& stencil,
                                                       Vector const& h) const {
    auto const sum = cayspin::detail::add_turning_field(first, stencil, h);
    if (others.any()) [[unlikely]]
      return others.add_field(stencil, sum);
    return sum;
  }
  // Without other terms the first is returned directly: g++ copies named values through memory.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto neighbor_field(Stencil const& stencil) const {
    if constexpr (sizeof...(Others) == 0)
      return first.neighbor_field(stencil);
    else
      return others.add_neighbor_field(stencil, first.neighbor_field(stencil));
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION auto energy_density(Stencil const& stencil) const {
    if constexpr (sizeof...(Others) == 0)
      return first.energy_density(stencil);
    else
      return others.add_energy_density(stencil, first.energy_density(stencil));
  }
};

/// Returns a scene's term for kernels, with default values if the scene does not have the term.
/// Lattice terms do not depend on the space, the spins or t, so they are prepared only once.
template <class OfScene>
auto library_term(std::optional<OfScene> const& term, Lattice const& lattice) {
  return term.value_or(OfScene{}).term(lattice).prepare(nullptr, nullptr, 0);
}

inline TermsIfThere<> terms_if_there(Lattice const&) { return {}; }
template <class OfScene, class... Others>
auto terms_if_there(Lattice const& lattice, std::optional<OfScene> const& term,
                    Others const&... others) {
  auto rest = terms_if_there(lattice, others...);
  auto made = library_term(term, lattice);
  return [&]<class... Rest>(TermsIfThere<Rest...> const& more) {
    return TermsIfThere<decltype(made), Rest...>{made, term.has_value(), more};
  }(rest);
}

/// Returns the lattice terms of a scene's [field].
inline auto lattice_terms_of(io::Field const& field, Lattice const& lattice) {
  double magnitude = 0;
  io::for_each_lattice_term(field, [&](auto const& term) {
    if (term) magnitude += term->energy_magnitude(lattice);
  });
  return std::apply(
      [&](auto first, auto... others) {
        auto made = library_term(field.*first, lattice);
        auto more = terms_if_there(lattice, field.*others...);
        return [&]<class... Others>(TermsIfThere<Others...> const& rest) {
          return LatticeTerms<decltype(made), Others...>{made, rest, magnitude};
        }(more);
      },
      io::Field::lattice_terms);
}
using SceneLatticeTerms = decltype(lattice_terms_of({}, {}));

}  // namespace cayspin::simulation
