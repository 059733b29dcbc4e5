// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/term_on_lattice.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>

namespace cayspin::inline v0_2 {

namespace detail {

/// ZhangLi for kernels, with velocity / (2 * spacing) for each axis; 0 along an axis of one site.
class UniformZhangLi {
 public:
  static constexpr bool is_conservative = false;  // H is the derivative of no energy

  UniformZhangLi(Lattice const& lattice, Vec3<double> const& velocity, double nonadiabaticity)
      : nonadiabaticity_(nonadiabaticity) {
    double const along[3] = {velocity.x, velocity.y, velocity.z};
    for (std::size_t axis = 0; axis < 3; ++axis)
      rate_[axis] = lattice.shape[axis] > 1 ? along[axis] / (2 * lattice.spacing[axis]) : 0.0;
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto d = zero<Value>();
    if (rate_[0] != 0) d = difference<0>(stencil, d);
    if (rate_[1] != 0) d = difference<1>(stencil, d);
    if (rate_[2] != 0) d = difference<2>(stencil, d);
    return multiply_add(as_value<Value>(-nonadiabaticity_), d, cross(d, stencil.center()));
  }

  /// Returns 0: the term has no energy.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const&) const {
    return ValueOf<Stencil>(0);
  }

 private:
  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector difference(Stencil const& stencil, Vector const& sum) const {
    using Value = typename Stencil::value_type;
    return multiply_add(as_value<Value>(rate_[Axis]),
                        stencil.template next<Axis>() - stencil.template previous<Axis>(), sum);
  }

  double rate_[3];
  double nonadiabaticity_;
};

}  // namespace detail

/// The torque of a current that flows through a magnetic texture,
/// t = -d + xi * m x d with d = (u.grad) m. It is written as a field in which precession gives t:
/// H = d x m - xi * d, which equals m x t up to a multiple of m. With damping, LandauLifshitz turns
/// H into the torque t + damping * m x t. d is computed from central differences across 2 spacings;
/// the spin itself replaces a missing neighbour. The velocity u is in units of length per unit of
/// time; xi has no unit. There is no energy: energy_density is 0, and code that needs an energy
/// refuses the term. Zhang and Li 2004.
class ZhangLi : public detail::TermOnLattice<detail::UniformZhangLi> {
 public:
  /// Throws std::invalid_argument when a number is not finite or the lattice is invalid.
  ZhangLi(Lattice const& lattice, Vec3<double> const& velocity, double nonadiabaticity = 0)
      : TermOnLattice("cayspin::ZhangLi", lattice,
                      detail::finite(velocity, "cayspin::ZhangLi: the velocity"),
                      detail::finite(nonadiabaticity, "cayspin::ZhangLi: the nonadiabaticity")) {}
};

}  // namespace cayspin::inline v0_2
