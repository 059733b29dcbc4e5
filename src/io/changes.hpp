// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <vector>

/// In what two scenes differ, for a run that goes on from what another one left.
namespace cayspin::inline v0_1::io {

/// The first key by which two scenes of one shape and cell_sites have other sites:
/// "lattice.spacing", boundary, cell, basis, moments, gyromagnetic, occupied, frozen, or
/// "system.kind"; empty where all are equal. Compared as numbers: in SI, of every site. An axis of
/// one site has no spacing and no boundary, unless the field has demag. Throws SceneError where a
/// file cannot be read.
std::string changed_lattice_key(Scene const& before, Scene const& now);

/// The keys whose values differ between two scenes' texts, such as "field.applied", in the order of
/// the alphabet. 1 and 1.0 are equal; a default that is typed differs from one that is not. Throws
/// SceneError for a text that is not TOML.
std::vector<std::string> changed_keys(std::string const& before, std::string const& now);

}  // namespace cayspin::inline v0_1::io
