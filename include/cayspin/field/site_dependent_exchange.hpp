// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/for_each_site.hpp>
#include <cayspin/detail/ghosts.hpp>
#include <cayspin/field/coefficient.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <cstddef>
#include <limits>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2 {

namespace detail {

/// SiteDependentExchange for kernels: H_n = sum of A_nq * (m_q - m_n) / spacing^2. `bonds`: A_nq /
/// spacing^2 of the bond from each site to the next one, for each axis; an array without data
/// stands for no bonds along that axis.
template <class Real>
struct ExchangeOfSites {
  static constexpr int degree = 2;  // H is linear in the spins
  SiteArray<Real, 1> bonds[3] = {};

  KOKKOS_FORCEINLINE_FUNCTION bool any() const {
    return bonds[0].data || bonds[1].data || bonds[2].data;
  }

  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> field(Stencil const& stencil) const {
    auto h = zero<ValueOf<Stencil>>();
    if (bonds[0].data) h = differences<0>(stencil, h);
    if (bonds[1].data) h = differences<1>(stencil, h);
    if (bonds[2].data) h = differences<2>(stencil, h);
    return h;
  }

  /// Returns H up to a multiple of the spin itself: the sum of A_nq * m_q / spacing^2.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION VectorOf<Stencil> neighbor_field(Stencil const& stencil) const {
    auto h = zero<ValueOf<Stencil>>();
    if (bonds[0].data) h = neighbor_sum<0>(stencil, h);
    if (bonds[1].data) h = neighbor_sum<1>(stencil, h);
    if (bonds[2].data) h = neighbor_sum<2>(stencil, h);
    return h;
  }

  /// Returns half the energy of all bonds of the site.
  template <class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION ValueOf<Stencil> energy_density(Stencil const& stencil) const {
    ValueOf<Stencil> e(0);
    if (bonds[0].data) e = energies<0>(stencil, e);
    if (bonds[1].data) e = energies<1>(stencil, e);
    if (bonds[2].data) e = energies<2>(stencil, e);
    return e;
  }

 private:
  template <class Stencil>
  struct BondsOfSite {
    ValueOf<Stencil> on, back;
    VectorOf<Stencil> next, previous;  // from the spin to its neighbours
  };
  // The bond to the previous site is stored at the previous site, as its bond to the next one. Past
  // an open end the constant does not matter, since it multiplies zero.
  template <int Axis, class Stencil>
  KOKKOS_FORCEINLINE_FUNCTION BondsOfSite<Stencil> with_differences(Stencil const& stencil) const {
    auto const on = stencil.site().load(bonds[Axis]);
    return {on, stencil.site().template neighbor<Axis, 0>(bonds[Axis], on),
            stencil.template next<Axis>() - stencil.center(),
            stencil.template previous<Axis>() - stencil.center()};
  }

  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector differences(Stencil const& stencil, Vector const& sum) const {
    auto const of = with_differences<Axis>(stencil);
    return multiply_add(of.on, of.next, multiply_add(of.back, of.previous, sum));
  }
  template <int Axis, class Stencil, class Vector>
  KOKKOS_FORCEINLINE_FUNCTION Vector neighbor_sum(Stencil const& stencil, Vector const& sum) const {
    auto const none = zero<ValueOf<Stencil>>();
    auto const on = stencil.site().load(bonds[Axis]);
    auto const back = stencil.site().template neighbor<Axis, 0>(bonds[Axis], on);
    return multiply_add(on, stencil.template next<Axis>(none),
                        multiply_add(back, stencil.template previous<Axis>(none), sum));
  }
  template <int Axis, class Stencil, class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value energies(Stencil const& stencil, Value const& sum) const {
    auto const of = with_differences<Axis>(stencil);
    return sum +
           Value(0.25) * (of.on * dot(of.next, of.next) + of.back * dot(of.previous, of.previous));
  }
};

/// Functor that computes the constants of the bonds to the next sites, divided by the spacing
/// squared.
template <class Real>
struct FindBonds {
  SiteArray<Real, 1> constants;
  OutputArray<Real, 1> bonds;
  int axis;
  double inverse_square;

  template <class Site>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site) const {
    auto const own = site.load(constants);
    site.store(axis == 0   ? mean(own, site.template neighbor<0, 1>(constants, own))
               : axis == 1 ? mean(own, site.template neighbor<1, 1>(constants, own))
                           : mean(own, site.template neighbor<2, 1>(constants, own)),
               bonds);
  }

 private:
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION Value mean(Value const& own, Value const& other) const {
    constexpr Real smallest = std::numeric_limits<Real>::min(),
                   least = smallest / std::numeric_limits<Real>::epsilon(),
                   most = std::numeric_limits<Real>::max();
    Value const all = own + other, product = own * other,
                factor = as_value<Value>(2 * inverse_square), scaled = factor * product;
    Value const sum = select<Value>(all == Value(0), Value(1), all);
    // For products that overflow or almost underflow.
    Value const far = factor * (own * (other / sum));
    Value const near = select<Value>(scaled < Value(most), scaled / sum, far);
    Value const found = select<Value>(scaled < Value(smallest), far, near);
    return select<Value>(Value(least) < product, found, far);
  }
};

}  // namespace detail

/// Exchange whose constant A differs from site to site. The constant of the bond between sites n
/// and q is the harmonic mean A_nq = 2 * A_n * A_q / (A_n + A_q), as for two half cells in series:
/// it keeps A * dm/dx continuous where A jumps, and a site with A = 0 has no bonds.
/// H_n = sum over neighbours q of A_nq * (m_q - m_n) / spacing^2,
/// E = sum over bonds of (A_nq / 2) * |m_q - m_n|^2 / spacing^2. A_nq / spacing^2 is stored as a
/// Real.
template <class Real, class MemorySpace>
class SiteDependentExchange : public detail::PreparedOnce {
 public:
  /// Spacings and boundaries are those of the constants' lattice. The bonds are computed once,
  /// here: if the constants change later, make a new term. Throws std::invalid_argument when a
  /// constant is not finite, or when some are positive and some negative.
  explicit SiteDependentExchange(ScalarField<Real, MemorySpace> constants)
      : constants_(std::move(constants)) {
    auto const signs =
        detail::signs_of(constants_, "cayspin::SiteDependentExchange: the constants");
    if (signs.negative && signs.positive)
      throw std::invalid_argument(
          "cayspin::SiteDependentExchange: the constants must all have the same sign, as the "
          "harmonic mean of a positive and a negative one is no bond");
    find_bonds();
  }

  template <class Spins>
  void check_spins(Spins const& spins) const {
    detail::require_lattice_of(spins, constants_, "cayspin::SiteDependentExchange");
  }

  template <class Exec, class Spins>
  detail::ExchangeOfSites<Real> prepare(Exec const&, Spins const&, double) const {
    return prepared();
  }
  /// Returns the term for kernels, which does not depend on time.
  detail::ExchangeOfSites<Real> prepared() const {
    detail::ExchangeOfSites<Real> prepared;
    for (int axis = 0; axis < 3; ++axis)
      if (bonds_[axis]) prepared.bonds[axis] = bonds_[axis]->array();
    return prepared;
  }

  /// Multiplies the constants of the bonds along an axis. `factors` has one number for each site
  /// except ghosts, with x varying fastest: the factor for the bond from that site to the next one.
  /// The copies of this term change, too. Throws std::invalid_argument for another number of
  /// factors. Does nothing along an axis of one site.
  void scale_bonds(int axis, std::vector<double> const& factors) {
    if (!bonds_[axis]) return;
    auto const& bonds = *bonds_[axis];
    auto const constants = copy_to_host(bonds);
    detail::require_size("cayspin::SiteDependentExchange", factors.size(), bonds.sites());
    std::vector<double> scaled(constants.begin(), constants.end());
    for (std::size_t site = 0; site < scaled.size(); ++site) scaled[site] *= factors[site];
    copy_from_host(scaled, bonds);
    typename MemorySpace::execution_space const exec;
    detail::update_ghosts(exec, bonds.lattice(), bonds);
    exec.fence("cayspin::SiteDependentExchange: bonds scaled");
  }

 private:
  void find_bonds() {
    using Exec = typename MemorySpace::execution_space;
    auto const& lattice = constants_.lattice();
    detail::fence_all_instances<Exec>("cayspin::SiteDependentExchange");
    Exec const exec;
    for (int axis = 0; axis < 3; ++axis) {
      if (!lattice.has_neighbors(axis)) continue;
      auto const& bonds = bonds_[axis].emplace("SiteDependentExchange::bonds", lattice);
      double const spacing = lattice.spacing[static_cast<std::size_t>(axis)];
      detail::FindBonds<Real> const find{constants_.array(), bonds.output(false), axis,
                                         1 / (spacing * spacing)};
      detail::for_each_site<Real>(exec, "cayspin::SiteDependentExchange", bonds.layout(), find,
                                  bonds.layout().own);
      detail::update_ghosts(exec, lattice, bonds);
    }
    exec.fence("cayspin::SiteDependentExchange: bonds found");
  }

  ScalarField<Real, MemorySpace> constants_;
  std::optional<ScalarField<Real, MemorySpace>> bonds_[3];
};

}  // namespace cayspin::inline v0_2
