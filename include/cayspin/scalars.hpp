// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/reduce_sites.hpp>
#include <cayspin/field/coefficient.hpp>
#include <cayspin/field/parts.hpp>
#include <cayspin/optional_members.hpp>
#include <cayspin/spin_field.hpp>
#include <cayspin/stencil.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2 {

namespace detail {

/// Computes the energy density, and the sum of the absolute values of its terms.
template <class Source, class Stencil, class Value>
KOKKOS_FORCEINLINE_FUNCTION void energy_at(Source const& source, Stencil const& stencil,
                                           Value* values) {
  static_assert(
      has_energy_density<Source, Stencil>,
      "An energy is that of an EffectiveField, a field term, or a generator that has one: "
      "a const, device-callable template energy_density(stencil).");
  values[0] = source.energy_density(stencil);
  values[1] = energy_magnitude(source, stencil);
}

template <class Source, class Real>
struct EnergyOfSites {
  Source source;
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    energy_at(source, Stencil<Site, Real>(site, spins), values);
  }
};

/// Functor that computes the energy densities of all terms, followed by their absolute values.
template <class Source, class Real>
struct TermEnergiesOfSites {
  Source source;
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    constexpr int terms = energy_terms<Source>;
    energy_densities(source, Stencil<Site, Real>(site, spins), values);
    for (int term = 0; term < terms; ++term) values[terms + term] = Kokkos::abs(values[term]);
  }
};

/// Computes how far m.m is above and below 1. norm_defect_of turns the largest of each over all
/// sites into the largest | |m| - 1 |, so that no site needs a root.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION void off_the_sphere(Vec3<Value> const& m, Value* values) {
  Value const square = dot(m, m);
  values[0] = square - Value(1.0);
  values[1] = Value(1.0) - square;
}
inline double norm_defect_of(double above, double below) {
  return Maximum::combine(std::sqrt(1 + above) - 1, 1 - std::sqrt(1 - below));
}

template <class Real>
struct NormDefectOfSites {
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    off_the_sphere(site.load(spins), values);
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

/// Returns |A x m|^2.
template <class Generator, class Stencil>
KOKKOS_FORCEINLINE_FUNCTION auto squared_torque(Generator const& generator,
                                                Stencil const& stencil) {
  auto const torque = cross(evaluate(generator, stencil), stencil.center());
  return dot(torque, torque);
}

template <class Generator, class Real>
struct TorqueOfSites {
  Generator generator;
  SiteArray<Real, 3> spins;

  template <class Site, class Value>
  KOKKOS_FORCEINLINE_FUNCTION void operator()(Site const& site, Value* values) const {
    values[0] = squared_torque(generator, Stencil<Site, Real>(site, spins));
  }
};

}  // namespace detail

/// An energy, summed over sites. `magnitude` is the sum of the absolute values of all summands (one
/// per site and term); the round-off of `value` is proportional to it.
struct Energy {
  double value = 0, magnitude = 0;
};

/// Returns the energy of `spins` at time t, in reduced units, summed over sites in double. `source`
/// is an EffectiveField, a field term, or a generator with an energy.
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

/// Returns the energy at time t of each term of an EffectiveField, in the order of its terms, in
/// one pass over the spins. The EffectiveField may be inside a FieldWithVacancies or a generator; a
/// single field term counts as an EffectiveField of one term.
template <class Exec, class Source, class Real, class MemorySpace>
std::array<Energy, static_cast<std::size_t>(detail::energy_terms<Source>)> term_energies(
    Exec const& exec, Source const& source, SpinField<Real, MemorySpace> const& spins,
    double t = 0) {
  detail::check_access<Exec, MemorySpace>();
  constexpr auto terms = static_cast<std::size_t>(detail::energy_terms<Source>);
  std::array<Energy, terms> energies{};
  auto prepared = detail::prepare_term(source, exec, spins, t);
  if constexpr (terms > 0) {
    auto const total = detail::reduce_sites<detail::Sum, static_cast<int>(2 * terms)>(
        exec, "cayspin::term_energies", spins.layout(),
        detail::TermEnergiesOfSites<decltype(prepared), Real>{std::move(prepared), spins.array()});
    for (std::size_t term = 0; term < terms; ++term)
      energies[term] = {total[term], total[terms + term]};
  }
  return energies;
}

/// Returns max | |m| - 1 |; NaN when any spin is NaN.
template <class Exec, class Real, class MemorySpace>
double norm_defect(Exec const& exec, SpinField<Real, MemorySpace> const& spins) {
  detail::check_access<Exec, MemorySpace>();
  auto const largest = detail::reduce_sites<detail::Maximum, 2>(
      exec, "cayspin::norm_defect", spins.layout(), detail::NormDefectOfSites<Real>{spins.array()});
  return detail::norm_defect_of(largest[0], largest[1]);
}

/// Returns the mean of m over the sites.
template <class Exec, class Real, class MemorySpace>
Vec3<double> magnetization(Exec const& exec, SpinField<Real, MemorySpace> const& spins) {
  detail::check_access<Exec, MemorySpace>();
  auto const total = detail::reduce_sites<detail::Sum, 3>(
      exec, "cayspin::magnetization", spins.layout(), detail::SpinOfSites<Real>{spins.array()});
  auto const sites = static_cast<double>(whole(spins.lattice()).sites());
  return {total[0] / sites, total[1] / sites, total[2] / sites};
}

/// Returns the weighted mean of m. With an occupation of 0 and 1 as weights, it is the mean over
/// the occupied sites. Throws std::invalid_argument when the weights are on another lattice or
/// their sum is zero.
template <class Exec, class Real, class MemorySpace>
Vec3<double> magnetization(Exec const& exec, SpinField<Real, MemorySpace> const& spins,
                           std::type_identity_t<ScalarField<Real, MemorySpace>> const& weights) {
  detail::check_access<Exec, MemorySpace>();
  detail::require_lattice_of(spins, weights, "cayspin::magnetization's weights");
  auto const total = detail::reduce_sites<detail::Sum, 4>(
      exec, "cayspin::magnetization", spins.layout(),
      detail::WeightedSpinOfSites<Real>{spins.array(), weights.array()});
  if (!(std::abs(total[3]) > 0))
    throw std::invalid_argument("cayspin::magnetization: the weights add up to zero");
  return {total[0] / total[3], total[1] / total[3], total[2] / total[3]};
}

/// Returns max |A x m|, the rate of the fastest spin at time t. Zero at equilibrium.
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

}  // namespace cayspin::inline v0_2
