// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/term_on_lattice.hpp>
#include <cayspin/lattice.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>

namespace cayspin::inline v0_2 {

namespace detail {

/// Exchange for kernels, with A / spacing^2 of each axis; 0 along an axis of one site.
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
    is_cubic_ =
        couples_[0] && coefficient_[0] == coefficient_[1] && coefficient_[1] == coefficient_[2];
  }

  bool couples_along_x() const { return couples_[0]; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    return add_field(stencil, zero<ValueOf<Stencil>>());
  }
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add_field(Stencil const& stencil,
                                                          VectorOf<Stencil> h) const {
    using Value = typename Stencil::value_type;
    if constexpr (one_at_a_time<Value>)
      return second_difference<0>(stencil,
                                  second_difference<1>(stencil, second_difference<2>(stencil, h)));
    if (is_cubic_) [[likely]] {
      // This form is exactly zero where all spins are equal, like that of second_difference.
      auto const in_plane =
          multiply_add(Value(-4), stencil.center(), pair<0>(stencil) + pair<1>(stencil));
      auto const across = multiply_add(Value(-2), stencil.center(), pair<2>(stencil));
      return multiply_add(scaled<0, Value>(1), in_plane + across, h);
    }
    if (couples_[0]) h = second_difference<0>(stencil, h);
    if (couples_[1]) h = second_difference<1>(stencil, h);
    if (couples_[2]) h = second_difference<2>(stencil, h);
    return h;
  }
  /// Adds H up to a multiple of the spin itself: for each axis, A / spacing^2 times the sum of the
  /// two neighbours. Past an open end, the spin replaces the missing neighbour.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> add_turning_field(Stencil const& stencil,
                                                                  VectorOf<Stencil> h) const {
    using Value = typename Stencil::value_type;
    if constexpr (one_at_a_time<Value>)
      return pair_sum<0>(stencil, pair_sum<1>(stencil, pair_sum<2>(stencil, h)));
    if (is_cubic_) [[likely]]
      return multiply_add(scaled<0, Value>(1),
                          pair<0>(stencil) + pair<1>(stencil) + pair<2>(stencil), h);
    if (couples_[0]) h = pair_sum<0>(stencil, h);
    if (couples_[1]) h = pair_sum<1>(stencil, h);
    if (couples_[2]) h = pair_sum<2>(stencil, h);
    return h;
  }

  /// Returns H up to a multiple of the spin itself: the sum over the axes of A / spacing^2 times
  /// the sum of the existing neighbours.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto h = zero<Value>();
    if (couples_[0]) h = neighbor_sum<0>(stencil, h);
    if (couples_[1]) h = neighbor_sum<1>(stencil, h);
    if (couples_[2]) h = neighbor_sum<2>(stencil, h);
    return h;
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
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

  template <int Axis, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION static auto pair(Stencil const& stencil) {
    return stencil.template previous<Axis>() + stencil.template next<Axis>();
  }

  // Adds (A / spacing^2) * (previous + next - 2 * center), in a form that is exactly zero where the
  // three are equal.
  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector second_difference(Stencil const& stencil,
                                                       Vector const& sum) const {
    using Value = typename Stencil::value_type;
    return multiply_add(scaled<Axis, Value>(1),
                        multiply_add(Value(-2), stencil.center(), pair<Axis>(stencil)), sum);
  }

  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector pair_sum(Stencil const& stencil, Vector const& sum) const {
    using Value = typename Stencil::value_type;
    return multiply_add(scaled<Axis, Value>(1), pair<Axis>(stencil), sum);
  }

  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector neighbor_sum(Stencil const& stencil, Vector const& sum) const {
    using Value = typename Stencil::value_type;
    auto const none = zero<Value>();
    return multiply_add(scaled<Axis, Value>(1),
                        stencil.template previous<Axis>(none) + stencil.template next<Axis>(none),
                        sum);
  }

  // Adds half the energy of the site's bonds along an axis.
  template <int Axis, class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value bonds(Stencil const& stencil, Value const& sum) const {
    auto const back = stencil.template previous<Axis>() - stencil.center();
    auto const on = stencil.template next<Axis>() - stencil.center();
    return detail::multiply_add(scaled<Axis, Value>(0.25), Value(dot(back, back) + dot(on, on)),
                                sum);
  }

  double coefficient_[3];
  bool couples_[3];  // true if the axis has a nonzero coefficient
  bool is_cubic_;    // true if all axes have the same nonzero coefficient
};

}  // namespace detail

/// Exchange with the nearest neighbours along each axis, with the constant A:
/// H_n = sum over existing neighbours q of A * (m_q - m_n) / spacing^2,
/// E = sum over bonds between sites n and q of (A / 2) * |m_q - m_n|^2 / spacing^2.
class Exchange : public detail::TermOnLattice<detail::UniformExchange> {
 public:
  /// Throws std::invalid_argument when the constant is not finite or the lattice is invalid.
  Exchange(Lattice const& lattice, double constant)
      : TermOnLattice("cayspin::Exchange", lattice,
                      detail::finite(constant, "cayspin::Exchange: the constant")) {}
};

}  // namespace cayspin::inline v0_2
