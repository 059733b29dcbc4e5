// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <vector>

/// Differences between two scenes, for a run that continues from the state of another.
namespace cayspin::inline v0_2::io {

/// Returns the first key by which two scenes of equal shape and cell_sites have different sites:
/// "lattice.spacing", boundary, cell, basis, moments, gyromagnetic, occupied, frozen, or
/// "system.kind"; empty if none differs. Spacings are compared in SI, site-dependent numbers site
/// by site. Spacing and boundary of an axis with one cell are ignored, except in crystals with
/// several sites per cell and with demag. Throws SceneError when a file cannot be read.
std::string changed_lattice_key(Scene const& before, Scene const& now);

/// Returns the keys whose values differ between two scene texts, such as "field.applied", in
/// alphabetical order. 1 and 1.0 are equal; a default that is typed differs from one that is not.
/// Throws SceneError for a text that is not TOML.
std::vector<std::string> changed_keys(std::string const& before, std::string const& now);

}  // namespace cayspin::inline v0_2::io
