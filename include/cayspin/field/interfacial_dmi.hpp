// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/term_on_lattice.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/stencil.hpp>

#include <cmath>
#include <cstddef>
#include <stdexcept>

namespace cayspin::inline v0_2 {

namespace detail {

/// InterfacialDmi for kernels, with the vector (D / spacing) * (n x e) of each axis e; 0 along an
/// axis of one site.
class UniformInterfacialDmi {
 public:
  static constexpr int degree = 2;  // H is linear in the spins

  UniformInterfacialDmi(Lattice const& lattice, double constant, Vec3<double> const& normal) {
    double const length = std::hypot(normal.x, normal.y, normal.z);
    if (!(length > 0) || !std::isfinite(length))
      throw std::invalid_argument(
          "cayspin::InterfacialDmi: the normal must be finite and not zero");
    Vec3<double> const axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      double const scale =
          lattice.shape[axis] > 1 ? constant / (lattice.spacing[axis] * length) : 0.0;
      vector_[axis] = scale * cross(normal, axes[axis]);
    }
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    auto h = zero<ValueOf<Stencil>>();
    if (acts<0>()) h = bonds<0>(stencil, h);
    if (acts<1>()) h = bonds<1>(stencil, h);
    if (acts<2>()) h = bonds<2>(stencil, h);
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
  template <std::size_t Axis>
  KOKKOS_FORCEINLINE_FUNCTION bool acts() const {
    return vector_[Axis].x != 0 || vector_[Axis].y != 0 || vector_[Axis].z != 0;
  }

  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector bonds(Stencil const& stencil, Vector const& sum) const {
    using Value = typename Stencil::value_type;
    Vector const v{as_value<Value>(vector_[Axis].x), as_value<Value>(vector_[Axis].y),
                   as_value<Value>(vector_[Axis].z)};
    return sum + cross(v, difference<Axis>(stencil));
  }

  Vec3<double> vector_[3];
};

}  // namespace detail

/// Interfacial Dzyaloshinskii-Moriya interaction of a film with unit normal n, with energy density
/// D * (m_n div m - m.grad m_n). A bond from spin m along the axis e to its neighbour m' has
/// E = (D / spacing) * (m x m').(n x e), so that
/// H = sum over axes of (D / spacing) * (n x e) x (m_next - m_previous). A missing neighbour has no
/// bond. With Exchange(lattice, A), a free spiral along an axis e in the film turns by atan(D *
/// spacing / A) from site to site. Rohart and Thiaville 2013.
class InterfacialDmi : public detail::TermOnLattice<detail::UniformInterfacialDmi> {
 public:
  /// `normal` is normalised. Throws std::invalid_argument when it is zero or not finite, the
  /// constant is not finite, or the lattice is invalid.
  InterfacialDmi(Lattice const& lattice, double constant, Vec3<double> const& normal = {0, 0, 1})
      : TermOnLattice("cayspin::InterfacialDmi", lattice,
                      detail::finite(constant, "cayspin::InterfacialDmi: the constant"), normal) {}
};

}  // namespace cayspin::inline v0_2
