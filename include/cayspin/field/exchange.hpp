// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/term_on_lattice.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>

namespace cayspin {

namespace detail {

/// What kernels hold of Exchange: A / spacing^2 of each axis, or 0.
class UniformExchange {
 public:
  static constexpr int degree = 2;  // H is linear in the spins

  UniformExchange(Lattice const& lattice, double constant) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      coefficient_[axis] = lattice.shape[axis] > 1
                               ? constant / (lattice.spacing[axis] * lattice.spacing[axis])
                               : 0.0;
      couples_[axis] = coefficient_[axis] != 0;
    }
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto h = zero<Value>();
    if (couples_[0]) h = second_difference<0>(stencil, h);
    if (couples_[1]) h = second_difference<1>(stencil, h);
    if (couples_[2]) h = second_difference<2>(stencil, h);
    return h;
  }

  /// A sum of neighbours / spacing^2: H without a multiple of the spin itself.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> neighbor_field(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto h = zero<Value>();
    if (couples_[0]) h = neighbor_sum<0>(stencil, h);
    if (couples_[1]) h = neighbor_sum<1>(stencil, h);
    if (couples_[2]) h = neighbor_sum<2>(stencil, h);
    return h;
  }

  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const { return false; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION typename Stencil::value_type energy_density(
      Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value e(0);
    if (couples_[0]) e = bonds<0>(stencil, e);
    if (couples_[1]) e = bonds<1>(stencil, e);
    if (couples_[2]) e = bonds<2>(stencil, e);
    return e;
  }

 private:
  template <int Axis, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value scaled(double factor) const {
    return as_value<Value>(factor * coefficient_[Axis]);
  }

  // previous + next - 2 center, in a form that is exactly zero where the three are equal.
  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector second_difference(Stencil const& stencil,
                                                       Vector const& sum) const {
    using Value = typename Stencil::value_type;
    Vector const both = stencil.template previous<Axis>() + stencil.template next<Axis>();
    return multiply_add(scaled<Axis, Value>(1), multiply_add(Value(-2), stencil.center(), both),
                        sum);
  }

  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector neighbor_sum(Stencil const& stencil, Vector const& sum) const {
    using Value = typename Stencil::value_type;
    auto const none = zero<Value>();
    return multiply_add(scaled<Axis, Value>(1),
                        stencil.template previous<Axis>(none) + stencil.template next<Axis>(none),
                        sum);
  }

  // Each site carries half of each of its bonds.
  template <int Axis, class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value bonds(Stencil const& stencil, Value const& sum) const {
    auto const back = stencil.template previous<Axis>() - stencil.center();
    auto const on = stencil.template next<Axis>() - stencil.center();
    return detail::multiply_add(scaled<Axis, Value>(0.25), Value(dot(back, back) + dot(on, on)),
                                sum);
  }

  double coefficient_[3];
  bool couples_[3];  // is the coefficient of the axis not 0?
};

}  // namespace detail

/// Exchange with the nearest neighbours along each axis: H = A Lap(m), the second difference over
/// existing neighbours, each divided by the axis' spacing squared.
/// E = sum over bonds of (A/2) |m_q - m_n|^2 / spacing^2.
class Exchange : public detail::TermOnLattice<detail::UniformExchange> {
 public:
  Exchange(Lattice const& lattice, double constant)
      : TermOnLattice("cayspin::Exchange", lattice, constant) {}
};

}  // namespace cayspin
