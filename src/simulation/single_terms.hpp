// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "io/trajectory.hpp"

#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation {

/// Returns scenes with only one term of the field each, by the name of its key.
std::vector<std::pair<std::string, io::Scene>> single_terms(io::Scene const& scene);

/// Returns the numbers of a scene's samples besides Scalars. For rigid bodies the one term is
/// "rotation".
io::MoreScalars more_scalars(io::Scene const& scene);

/// Refuses a scene for a continued run if the samples of its file have energies of other terms.
/// `first`: the scene that it started with.
void require_same_terms(io::Scene const& first, io::Scene const& scene);

}  // namespace cayspin::simulation
