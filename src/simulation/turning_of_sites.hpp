// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <vector>

namespace cayspin::simulation {

/// How spins turn in H = -dE/dm, given their moments, gyromagnetic ratios and damping: dm/dt =
/// -precession * (m x H) - damping * (m x (m x H)).
struct TurningOfSites {
  std::vector<double> precession, damping;
};

/// Returns the values of all sites, in the order of io::initial_spins.
TurningOfSites turning_of_sites(io::Scene const& scene);

/// Returns mu / g of all sites in reduced units, that is 1 / TurningOfSites::precession; 0 where a
/// spin does not precess. Takes a Turn, because the numbers may be in files.
std::vector<double> moments_over_g(io::Scene const& scene);

}  // namespace cayspin::simulation
