// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "time_features.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/lattice.hpp>

namespace cayspin::simulation {

/// The largest damping of a site. Throws io::SceneError for a negative one.
double largest_damping(io::Scene const& scene);

/// An upper bound of |H| at any site and time of a run, torques included. Throws io::SceneError
/// where an applied field or a constant of a site cannot be.
double field_bound(io::Scene const& scene, Lattice const& lattice, Times const& times,
                   TimeFeatures const& features);

/// An upper bound of |A|: of rigid bodies the largest row sum of I^-1, where it is in the scene.
double largest_rate(io::Scene const& scene, Lattice const& lattice, Times const& times,
                    TimeFeatures const& features);

}  // namespace cayspin::simulation
