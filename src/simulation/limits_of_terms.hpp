// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cayspin/lattice.hpp>

namespace cayspin::simulation {

/// Largest accepted ratio of an interlayer's strength to that of the exchange in half a cell.
inline constexpr double most_at_faces = 1.0 / 3;

/// Throws io::SceneError if interlayers are too strong for the exchange beside them, or if that
/// exchange is negative.
void require_limits_of_terms(io::Scene const& scene, Lattice const& lattice);

}  // namespace cayspin::simulation
