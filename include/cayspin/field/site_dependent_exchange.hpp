// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/field/coefficient.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>
#include <stdexcept>
#include <utility>

namespace cayspin::inline v0_1 {

namespace detail {

/// H_n = sum of A_nq (m_q - m_n) / spacing^2, with 1 / spacing^2 of each axis or 0.
template <class Real>
struct ExchangeOfSites {
  static constexpr int degree = 2;  // H is linear in the spins
  SiteArray<Real, 1> constants;
  double inverse_square[3];

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const own = stencil.site().load(constants);
    auto h = zero<Value>();
    if (inverse_square[0] != 0) h = differences<0>(stencil, own, h);
    if (inverse_square[1] != 0) h = differences<1>(stencil, own, h);
    if (inverse_square[2] != 0) h = differences<2>(stencil, own, h);
    return h;
  }

  /// Sum of A_nq m_q / spacing^2: H without a multiple of the spin itself.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const own = stencil.site().load(constants);
    auto h = zero<Value>();
    if (inverse_square[0] != 0) h = neighbor_sum<0>(stencil, own, h);
    if (inverse_square[1] != 0) h = neighbor_sum<1>(stencil, own, h);
    if (inverse_square[2] != 0) h = neighbor_sum<2>(stencil, own, h);
    return h;
  }

  KOKKOS_FORCEINLINE_FUNCTION bool local_field_varies() const { return false; }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    Value const own = stencil.site().load(constants);
    Value e(0);
    if (inverse_square[0] != 0) e = bonds<0>(stencil, own, e);
    if (inverse_square[1] != 0) e = bonds<1>(stencil, own, e);
    if (inverse_square[2] != 0) e = bonds<2>(stencil, own, e);
    return e;
  }

 private:
  /// The constant of the bond to a neighbour over the spacing squared, times `factor`; the same
  /// bits from either end.
  template <int Axis, int Direction, class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value bond(Site const& site, Value const& own,
                                         double factor = 1) const {
    Value const other = site.template neighbor<Axis, Direction>(constants, own);
    Value const sum = own + other;
    Value const mean = Value(2) * (own * other) / select<Value>(sum == Value(0), Value(1), sum);
    return coefficient<Value>(factor * inverse_square[Axis], site) * mean;
  }

  template <int Axis, class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> differences(Stencil const& stencil, Value const& own,
                                                      Vec3<Value> const& sum) const {
    auto const back = stencil.template previous<Axis>() - stencil.center();
    auto const on = stencil.template next<Axis>() - stencil.center();
    return multiply_add(bond<Axis, 1>(stencil.site(), own), on,
                        multiply_add(bond<Axis, 0>(stencil.site(), own), back, sum));
  }

  template <int Axis, class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> neighbor_sum(Stencil const& stencil, Value const& own,
                                                       Vec3<Value> const& sum) const {
    auto const none = zero<Value>();
    return multiply_add(bond<Axis, 1>(stencil.site(), own), stencil.template next<Axis>(none),
                        multiply_add(bond<Axis, 0>(stencil.site(), own),
                                     stencil.template previous<Axis>(none), sum));
  }

  // Each site carries half of each of its bonds.
  template <int Axis, class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value bonds(Stencil const& stencil, Value const& own,
                                          Value const& sum) const {
    auto const back = stencil.template previous<Axis>() - stencil.center();
    auto const on = stencil.template next<Axis>() - stencil.center();
    return multiply_add(
        bond<Axis, 1>(stencil.site(), own, 0.25), dot(on, on),
        multiply_add(bond<Axis, 0>(stencil.site(), own, 0.25), dot(back, back), sum));
  }
};

}  // namespace detail

/// Exchange whose constant A differs from site to site. The constant of the bond between sites n
/// and q is the harmonic mean A_nq = 2 A_n A_q / (A_n + A_q), that of two half cells in series: it
/// keeps A dm/dx continuous where A jumps, and a site with A = 0 has no bonds.
/// H_n = sum over neighbours of A_nq (m_q - m_n) / spacing^2,
/// E = sum over bonds of (A_nq / 2) |m_q - m_n|^2 / spacing^2.
template <class Real, class MemorySpace>
class SiteDependentExchange : public detail::PreparedOnce {
  using Prepared = detail::ExchangeOfSites<Real>;

 public:
  /// Spacings and boundaries are those of the constants' lattice. Throws std::invalid_argument when
  /// a constant is not finite, or when some are positive and some negative.
  explicit SiteDependentExchange(ScalarField<Real, MemorySpace> constants)
      : constants_(std::move(constants)) {
    auto const signs =
        detail::signs_of(constants_, "cayspin::SiteDependentExchange: the constants");
    if (signs.negative && signs.positive)
      throw std::invalid_argument(
          "cayspin::SiteDependentExchange: the constants must have one sign, as the harmonic mean "
          "of a positive and a negative one is no bond");
  }

  template <class Spins>
  void check_spins(Spins const& spins) const {
    detail::require_lattice_of(spins, constants_, "cayspin::SiteDependentExchange");
  }

  template <class Exec, class Spins>
  Prepared prepare(Exec const&, Spins const&, double) const {
    auto const& lattice = constants_.lattice();
    Prepared prepared{constants_.array(), {0, 0, 0}};
    for (std::size_t axis = 0; axis < 3; ++axis)
      if (lattice.shape[axis] > 1)
        prepared.inverse_square[axis] = 1 / (lattice.spacing[axis] * lattice.spacing[axis]);
    return prepared;
  }

 private:
  ScalarField<Real, MemorySpace> constants_;
};

}  // namespace cayspin::inline v0_1
