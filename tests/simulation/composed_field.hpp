// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "composed_terms.hpp"
#include "random_composition.hpp"

#include <cayspin/cayspin.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace cayspin::simulation::test {

/// Returns the field of a composition, from terms of the library and of composed_terms.hpp.
inline auto composed_field(CompositionNumbers const& n) {
  auto const& lattice = n.lattice;
  auto const occupation = field_of_sites(lattice, n.occupied, 1);
  auto per_moment = n.moment_of_sites;
  for (double& number : per_moment) number = number == 0 ? 0 : n.gyromagnetic / number;
  auto const moments = field_of_sites(lattice, n.moment_of_sites, n.moment);
  auto squares = n.moment_of_sites;  // H of a slab depends on moments only if they differ
  for (double& number : squares) number *= number;
  SlabOfSites const slab{
      field_of_sites(lattice, squares, 1),
      (1 / std::sqrt(dot(n.normal_of_slab, n.normal_of_slab))) * n.normal_of_slab, n.slab};
  EffectiveField const exchange(
      Exchange(lattice, n.exchange),
      SiteDependentExchange<double, Memory>(field_of_sites(lattice, n.exchange_of_sites, 0)));
  EffectiveField const dmi(InterfacialDmi(lattice, n.interfacial), BulkDmi(lattice, n.bulk));
  EffectiveField const anisotropy(
      UniaxialAnisotropy(n.constant[0], n.axis[0]), UniaxialAnisotropy(n.constant[1], n.axis[1]),
      SiteDependentUniaxialAnisotropy(field_of_sites(lattice, n.constant_of_sites, 0),
                                      n.axis_of_sites),
      CubicAnisotropy(n.cubic, {1, 0, 0}, {0, 1, 0}), CrystalByPolynomials{n.cubic2, n.hexagonal});
  EffectiveField const inside(
      ChangesInTime{exchange, n.exchange_in_time}, ChangesInTime{dmi, n.dmi_in_time},
      ChangesInTime{anisotropy, n.anisotropy_in_time}, slab,
      SiteDependentApplied{moments, field_of_sites(lattice, n.source_of_sites, 0), n.applied,
                           n.source_along_y});
  EffectiveField const gradient(
      FieldWithVacancies(inside, occupation), PairCouplings<Memory>(lattice, n.couplings),
      ChangesInTime{PairCouplings<Memory>(lattice, n.d2d), n.dmi_in_time});
  ScaledBySite const gradient_per_moment{
      gradient, field_of_sites(lattice, per_moment, n.gyromagnetic / n.moment)};
  bool const is_site_dependent = !n.damping_like_of_sites.empty();
  std::vector<double> along_x(static_cast<std::size_t>(lattice.sites()));
  for (std::size_t site = 0; site < along_x.size(); ++site)
    along_x[site] =
        n.along_x * static_cast<double>(static_cast<std::int64_t>(site) % lattice.shape[0]);
  EffectiveField const torques(
      ZhangLi(lattice, n.velocity, n.nonadiabaticity),
      Slonczewski({.damping_like = n.damping_like,
                   .field_like = is_site_dependent ? 0 : n.field_like,
                   .polarization = {0, 0.6, 0.8}}),
      SiteDependentSlonczewski{field_of_sites(lattice, n.damping_like_of_sites, 0),
                               field_of_sites(lattice, along_x, 0),
                               is_site_dependent ? n.field_like : 0, n.lambda});
  // Torques do not depend on the gyromagnetic ratios. TurnsAtRates multiplies all of A by these
  // ratios, so the torques are divided by them beforehand.
  auto per_ratio = n.gyromagnetic_of_sites;
  for (double& ratio : per_ratio) ratio = 1 / ratio;
  ScaledBySite const torques_per_ratio{FieldWithVacancies(torques, occupation),
                                       field_of_sites(lattice, per_ratio, 1)};
  return EffectiveField(gradient_per_moment, torques_per_ratio);
}

/// A generator that multiplies the rate of each spin: by 0 for frozen spins, otherwise by its
/// gyromagnetic ratio.
template <class Generator>
struct TurnsAtRates {
  Generator generator;
  ScalarField<double, Memory> rates;

  struct Now {
    Prepared<Generator> prepared;
    SiteArray<double, 1> rates;

    template <class Stencil>
    KOKKOS_FORCEINLINE_FUNCTION Vec3<typename Stencil::value_type> operator()(
        Stencil const& stencil) const {
      return stencil.site().load(rates) * prepared(stencil);
    }
  };
  template <class Exec, class Spins>
  Now prepare(Exec const& exec, Spins const& spins, double t) const {
    return {cayspin::detail::prepare_term(generator, exec, spins, t), rates.array()};
  }
};

/// Returns the spins after `time`, computed by RKMK4.
template <class Field>
std::vector<double> spins_after(CompositionNumbers const& n, Field const& field,
                                std::vector<double> const& start, double time) {
  SpinField<double, Memory> spins("spins", n.lattice);
  copy_from_host(start, spins);
  auto damping = n.damping_of_sites;
  std::vector<double> rates(static_cast<std::size_t>(n.lattice.sites()), 1);
  if (damping.empty()) damping.assign(rates.size(), n.damping);
  for (std::size_t site = 0; site < rates.size(); ++site)
    if (!n.frozen.empty() && n.frozen[site] != 0)
      rates[site] = 0;
    else if (!n.gyromagnetic_of_sites.empty())
      rates[site] = n.gyromagnetic_of_sites[site];
  LandauLifshitz const generator(field, field_of_sites(n.lattice, damping, 0));
  TurnsAtRates<decltype(generator)> const turning{generator, field_of_sites(n.lattice, rates, 1)};
  Rkmk4<SpinField<double, Memory>> stepper(spins);
  constexpr int steps = 32;
  for (int step = 0; step < steps; ++step)
    stepper.step(Space(), turning, spins, step * time / steps, time / steps);
  return copy_to_host(spins);
}

}  // namespace cayspin::simulation::test
