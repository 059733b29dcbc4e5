// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "time_features.hpp"

#include <cayspin/integrate.hpp>
#include <cayspin/lattice.hpp>

namespace cayspin::simulation {

/// Returns the largest damping of any site. Throws io::SceneError if one is negative.
double largest_damping(io::Scene const& scene);

/// Returns the smallest damping of any site.
double least_damping(io::Scene const& scene);

/// Returns an upper bound on |H| times the gyromagnetic ratio at any site, including torques, at
/// 1001 times of a run and at its time features. A demagnetising field contributes a bound on its
/// eigenvalues; |H| at a single site may exceed that bound. A program's own nonlocal field is not
/// included. Throws io::SceneError for an invalid applied field or site-dependent constant.
double field_bound(io::Scene const& scene, Lattice const& lattice, Times const& times,
                   TimeFeatures const& features);

/// Returns an upper bound on |H| due to point dipoles; 0 without them.
double bound_of_dipoles(io::Scene const& scene, Lattice const& lattice);

/// Returns an upper bound on the length |A| of the generator, from field_bound; for rigid bodies
/// the largest row sum of |I^-1|, where I is the inertia, or 0 if the inertia is in a file.
double largest_rate(io::Scene const& scene, Lattice const& lattice, Times const& times,
                    TimeFeatures const& features);

}  // namespace cayspin::simulation
