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
