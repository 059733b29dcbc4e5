// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stencil.hpp>

namespace cayspin::test {

/// E = -constant times the sum of (m.m')^2 over nearest-neighbour bonds: a term with neighbours
/// whose H is cubic in the spins.
struct BiquadraticBonds {
  double constant;

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return as_value<ValueOf<Stencil>>(2 * constant) *
           (along<0>(stencil) + along<1>(stencil) + along<2>(stencil));
  }
  /// Returns half the sum of the energies of the site's bonds.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    return as_value<ValueOf<Stencil>>(-0.25) * dot(stencil.center(), field(stencil));
  }

 private:
  template <int Axis, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION static VectorOf<Stencil> along(Stencil const& stencil) {
    auto const none = zero<ValueOf<Stencil>>();
    VectorOf<Stencil> const back = stencil.template previous<Axis>(none),
                            on = stencil.template next<Axis>(none);
    return dot(stencil.center(), back) * back + dot(stencil.center(), on) * on;
  }
};

}  // namespace cayspin::test
