// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/term_on_lattice.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>

namespace cayspin::inline v0_2 {

namespace detail {

/// BulkDmi for kernels, with D / spacing of each axis; 0 along an axis of one site.
class UniformBulkDmi {
 public:
  static constexpr int degree = 2;  // H is linear in the spins

  UniformBulkDmi(Lattice const& lattice, double constant) {
    for (std::size_t axis = 0; axis < 3; ++axis)
      strength_[axis] = lattice.shape[axis] > 1 ? constant / lattice.spacing[axis] : 0.0;
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return add_field(stencil, zero<ValueOf<Stencil>>());
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add_field(Stencil const& stencil,
                                                          VectorOf<Stencil> h) const {
    if (strength_[0] != 0) h = bonds<0>(stencil, h);
    if (strength_[1] != 0) h = bonds<1>(stencil, h);
    if (strength_[2] != 0) h = bonds<2>(stencil, h);
    return h;
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Stencil const& stencil) const {
    return field(stencil);
  }

  /// Returns half the energy of all bonds of the site.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    return Value(Value(-0.5) * dot(stencil.center(), field(stencil)));
  }

 private:
  /// Returns h + (D / spacing) * (m_next - m_previous) x e, with the unit vector e along Axis.
  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector bonds(Stencil const& stencil, Vector const& h) const {
    using Value = typename Stencil::value_type;
    auto const plus = as_value<Value>(strength_[Axis]), minus = as_value<Value>(-strength_[Axis]);
    Vector const d = difference<Axis>(stencil);
    if constexpr (Axis == 0)
      return {h.x, detail::multiply_add(plus, d.z, h.y), detail::multiply_add(minus, d.y, h.z)};
    else if constexpr (Axis == 1)
      return {detail::multiply_add(minus, d.z, h.x), h.y, detail::multiply_add(plus, d.x, h.z)};
    else
      return {detail::multiply_add(plus, d.y, h.x), detail::multiply_add(minus, d.x, h.y), h.z};
  }

  double strength_[3];
};

}  // namespace detail

/// Dzyaloshinskii-Moriya interaction of a chiral crystal, with energy density D * m.(curl m). A
/// bond from spin m along the axis e to its neighbour m' has
/// E = -(D / spacing) * (m x m').e, so that
/// H = sum over axes of (D / spacing) * (m_next - m_previous) x e. A missing neighbour has no bond.
/// With Exchange(lattice, A), a free spiral along e turns about e by atan(D * spacing / A) from
/// site to site. Reduced units. Bak and Jensen 1980.
class BulkDmi : public detail::TermOnLattice<detail::UniformBulkDmi> {
 public:
  /// Throws std::invalid_argument when the constant is not finite or the lattice is invalid.
  BulkDmi(Lattice const& lattice, double constant)
      : TermOnLattice("cayspin::BulkDmi", lattice,
                      detail::finite(constant, "cayspin::BulkDmi: the constant")) {}
};

}  // namespace cayspin::inline v0_2
