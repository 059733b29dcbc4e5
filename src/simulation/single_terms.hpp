// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "io/trajectory.hpp"

#include <string>
#include <utility>
#include <vector>

namespace cayspin::simulation {

/// Returns, for each term of the field, the name of its key and a scene with only that term.
std::vector<std::pair<std::string, io::Scene>> single_terms(io::Scene const& scene);

/// Stores the values of constants that are computed from other terms (at free boundaries, from DMI
/// and exchange) in `terms`. Call it before these other terms are removed from a copy of the scene.
void keep_numbers_of_free_sides(io::Scene const& scene, std::vector<io::Anisotropy>& terms);

/// Returns which numbers a scene's samples have in addition to Scalars. Rigid bodies have one term,
/// "rotation".
io::MoreScalars more_scalars(io::Scene const& scene);

/// Throws io::SceneError if the samples of a scene would have energies of other terms than those of
/// `first`, the scene with which the run started.
void require_same_terms(io::Scene const& first, io::Scene const& scene);

}  // namespace cayspin::simulation
