// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/concepts.hpp>
#include <cayspin/detail/coefficient.hpp>
#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <cmath>
#include <stdexcept>
#include <type_traits>

namespace cayspin {

namespace detail {

template <class Source, class Real>
struct EnergyOfSites {
  Source source;
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, spins);
    values[0] = source.energy_density(stencil);
    if constexpr (requires { source.energy_magnitude(stencil); })
      values[1] = source.energy_magnitude(stencil);
    else
      values[1] = Kokkos::abs(values[0]);
  }
};

template <class Real>
struct NormDefectOfSites {
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    auto const m = site.load(spins);
    values[0] = Kokkos::abs(Value(square_root<Value>(dot(m, m)) - Value(1.0)));
  }
};

template <class Real>
struct SpinOfSites {
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    auto const m = site.load(spins);
    values[0] = m.x;
    values[1] = m.y;
    values[2] = m.z;
  }
};

template <class Real>
struct WeightedSpinOfSites {
  SiteArray<Real, 3> spins;
  SiteArray<Real, 1> weights;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    SpinOfSites<Real>{spins}(site, values);
    values[3] = site.load(weights);
    for (int i = 0; i < 3; ++i) values[i] = values[3] * values[i];
  }
};

template <class Generator, class Real>
struct TorqueOfSites {
  Generator generator;
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    Stencil<Site, Real> const stencil(site, spins);
    auto const torque = cross(generator(stencil), stencil.center());
    values[0] = dot(torque, torque);
  }
};

}  // namespace detail

/// An energy summed over sites, and the sum of the absolute values of its terms, to which its
/// round-off is proportional.
struct Energy {
  double value = 0, magnitude = 0;
};

/// Energy of `spins` at time t, in reduced units, summed over sites in double. `source` is an
/// EffectiveField, a field term, or a generator that has an energy.
template <class Exec, class Source, class Real, class MemorySpace>
Energy energy(Exec const& exec, Source const& source, SpinField<Real, MemorySpace> const& spins,
              double t = 0) {
  detail::check_access<Exec, MemorySpace>();
  auto prepared = detail::prepare_term(source, exec, spins, t);
  auto const total = detail::reduce_sites<detail::Sum, 2>(
      exec, "cayspin::energy", spins.layout(),
      detail::EnergyOfSites<decltype(prepared), Real>{std::move(prepared), spins.array()});
  return {total[0], total[1]};
}

/// max | |m| - 1 |; NaN when any spin is NaN.
template <class Exec, class Real, class MemorySpace>
double norm_defect(Exec const& exec, SpinField<Real, MemorySpace> const& spins) {
  detail::check_access<Exec, MemorySpace>();
  return detail::reduce_sites<detail::Maximum, 1>(
      exec, "cayspin::norm_defect", spins.layout(),
      detail::NormDefectOfSites<Real>{spins.array()})[0];
}

/// The mean of m over the sites.
template <class Exec, class Real, class MemorySpace>
Vec3<double> magnetization(Exec const& exec, SpinField<Real, MemorySpace> const& spins) {
  detail::check_access<Exec, MemorySpace>();
  auto const total = detail::reduce_sites<detail::Sum, 3>(
      exec, "cayspin::magnetization", spins.layout(), detail::SpinOfSites<Real>{spins.array()});
  auto const sites = static_cast<double>(spins.sites());
  return {total[0] / sites, total[1] / sites, total[2] / sites};
}

/// The mean of m with a weight for each site: with an occupation of 0 and 1 as weights, the mean
/// over the occupied sites. Throws std::invalid_argument when the weights are on another lattice or
/// their sum is zero.
template <class Exec, class Real, class MemorySpace>
Vec3<double> magnetization(Exec const& exec, SpinField<Real, MemorySpace> const& spins,
                           std::type_identity_t<ScalarField<Real, MemorySpace>> const& weights) {
  detail::check_access<Exec, MemorySpace>();
  detail::require_lattice_of(spins, weights, "cayspin::magnetization");
  auto const total = detail::reduce_sites<detail::Sum, 4>(
      exec, "cayspin::magnetization", spins.layout(),
      detail::WeightedSpinOfSites<Real>{spins.array(), weights.array()});
  if (!(std::abs(total[3]) > 0))
    throw std::invalid_argument("cayspin::magnetization: the weights add up to zero");
  return {total[0] / total[3], total[1] / total[3], total[2] / total[3]};
}

/// max |A x m|: how fast the fastest spin moves at time t. Zero at rest.
template <class Exec, class Generator, class Real, class MemorySpace>
double largest_rate(Exec const& exec, Generator const& generator,
                    SpinField<Real, MemorySpace> const& spins, double t = 0) {
  detail::check_access<Exec, MemorySpace>();
  auto prepared = detail::prepare_term(generator, exec, spins, t);
  auto const square = detail::reduce_sites<detail::Maximum, 1>(
      exec, "cayspin::largest_rate", spins.layout(),
      detail::TorqueOfSites<decltype(prepared), Real>{std::move(prepared), spins.array()});
  return Kokkos::sqrt(square[0]);
}

}  // namespace cayspin
