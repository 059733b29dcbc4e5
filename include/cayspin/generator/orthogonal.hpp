// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/stencil.hpp>

#include <utility>

namespace cayspin {

/// A generator without its part along the spin: A_o = A - (m.A) m.
template <class Generator>
class Orthogonal {
 public:
  explicit Orthogonal(Generator generator) : generator_(std::move(generator)) {}

  template <class Exec, class Spins>
  auto prepare(Exec const& exec, Spins const& spins, double t) const {
    auto prepared = detail::prepare_term(generator_, exec, spins, t);
    return Orthogonal<decltype(prepared)>(std::move(prepared));
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Vec3<Value> const a = detail::evaluate(generator_, stencil);
    Value const along = Value(0) - dot(stencil.center(), a);
    return multiply_add(along, stencil.center(), a);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    return generator_.energy_density(stencil);
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_magnitude(
      Stencil const& stencil) const {
    return generator_.energy_magnitude(stencil);
  }

 private:
  Generator generator_;
};

template <class Generator>
Orthogonal<Generator> orthogonal(Generator generator) {
  return Orthogonal<Generator>(std::move(generator));
}

}  // namespace cayspin
