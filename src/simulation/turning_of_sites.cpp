// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "turning_of_sites.hpp"

#include "turn.hpp"

#include <cstddef>

namespace cayspin::simulation {

TurningOfSites turning_of_sites(io::Scene const& scene) {
  io::SiteBox const box{{0, 0, 0}, scene.lattice.shape};
  auto const moments = io::moments_of_sites(scene, box);
  auto const& system = scene.system;
  auto const& lattice = scene.lattice;
  auto const ratios = io::gyromagnetic_of_sites(scene, box);
  std::vector<double> dampings;
  if (system.dampings.there())
    dampings = io::numbers_of_sites(scene, system.dampings, "system.damping", box);
  auto const in_plane = static_cast<std::size_t>(lattice.shape[0] * lattice.shape[1]);
  auto const sites = in_plane * static_cast<std::size_t>(lattice.shape[2]);
  TurningOfSites turning{std::vector<double>(sites), std::vector<double>(sites)};
  for (std::size_t site = 0; site < sites; ++site) {
    auto const of_cell = site / in_plane % lattice.basis.size();
    double const per_moment = moments.empty()     ? io::over_moment(lattice, of_cell, 1)
                              : moments[site] > 0 ? 1 / moments[site]
                                                  : 0;
    double const lambda = dampings.empty() ? system.damping : dampings[site];
    double const gilbert = system.gilbert_of_sites ? 1 + lambda * lambda : 1;
    double const ratio =
        ratios.empty() ? io::of_cell_site(lattice.gyromagnetic, of_cell) : ratios[site];
    double const rate = ratio * per_moment / gilbert;
    turning.precession[site] = system.precession ? rate : 0;
    turning.damping[site] = rate * lambda;
  }
  return turning;
}

std::vector<double> moments_over_g(io::Scene const& scene) {
  Turn const turn;
  auto values = turning_of_sites(scene).precession;
  for (double& value : values) value = value > 0 ? 1 / value : 0;
  return values;
}

}  // namespace cayspin::simulation
