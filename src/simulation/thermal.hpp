// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cayspin/units.hpp>

namespace cayspin::simulation {

/// Is there noise around the steps of a scene?
inline bool is_thermal(io::Scene const& scene) {
  return scene.thermal && scene.thermal->temperature > 0;
}

/// As typed: reduced, or in kelvin.
inline double typed_temperature(io::Scene const& scene) {
  double const reduced = scene.thermal->temperature;
  return scene.units.si ? reduced * scene.units.energy / units::boltzmann : reduced;
}

}  // namespace cayspin::simulation
