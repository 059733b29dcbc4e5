// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/term_on_lattice.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/stencil.hpp>

namespace cayspin::inline v0_1 {

namespace detail {

/// What kernels hold of Biquadratic.
class UniformBiquadratic {
 public:
  UniformBiquadratic(Lattice const& lattice, double constant) : constant_(constant) {
    for (int axis = 0; axis < 3; ++axis)
      couples_[axis] = constant != 0 && lattice.has_neighbors(axis);
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto sum = zero<Value>();
    if (couples_[0]) sum = bonds<0>(stencil, sum);
    if (couples_[1]) sum = bonds<1>(stencil, sum);
    if (couples_[2]) sum = bonds<2>(stencil, sum);
    return as_value<Value>(2 * constant_) * sum;
  }

  /// Each site carries half of each of its bonds.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(Value(-0.25) * dot(stencil.center(), field(stencil)));
  }

 private:
  /// sum + (m.m') m' of both neighbours along an axis
  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION static Vector bonds(Stencil const& stencil, Vector const& sum) {
    auto const none = zero<ValueOf<Stencil>>();
    Vector const &m = stencil.center(), back = stencil.template previous<Axis>(none),
                 on = stencil.template next<Axis>(none);
    return multiply_add(dot(m, on), on, multiply_add(dot(m, back), back, sum));
  }

  double constant_;
  bool couples_[3];
};

}  // namespace detail

/// Biquadratic exchange with the nearest neighbours along each axis:
/// E = -B sum over bonds of (m.m')^2, H = 2 B sum over neighbours of (m.m') m'.
/// B is the energy of a bond in reduced units, and not divided by the spacing. A missing neighbour
/// has no bond. Slonczewski 1991.
class Biquadratic : public detail::TermOnLattice<detail::UniformBiquadratic> {
 public:
  /// Throws std::invalid_argument when the constant is not finite.
  Biquadratic(Lattice const& lattice, double constant)
      : TermOnLattice("cayspin::Biquadratic", lattice,
                      detail::finite(constant, "cayspin::Biquadratic: the constant")) {}
};

}  // namespace cayspin::inline v0_1
