// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <vector>

/// Differences between two scenes, for a run of one that continues from a state of the other.
namespace cayspin::inline v0_2::io {

/// Returns the first key that gives two scenes of equal shape and cell_sites different sites; empty
/// if there is none. The keys are "system.kind" and, unless the scenes have rigid bodies, cell,
/// basis, spacing, boundary, moments, gyromagnetic, occupied and frozen of lattice, as in
/// "lattice.spacing". Spacings of scenes in SI are compared in m, and site-dependent moments and
/// gyromagnetic ratios in SI. Site-dependent numbers are compared site by site. But they count as
/// equal if both scenes name the same expression or file, in the same unit, or if both get the
/// numbers from a program. Along an axis with one cell, spacing and boundary are ignored, unless a
/// cell has several sites or a scene has demag or dipoles. Throws SceneError when a file cannot be
/// read.
std::string changed_lattice_key(Scene const& before, Scene const& now);

/// Returns the keys whose values differ between two scene texts, such as "field.applied", in
/// alphabetical order. 1 and 1.0 are equal; a key that is typed with its default value differs from
/// one that is not typed. Throws SceneError for a text that is not TOML.
std::vector<std::string> changed_keys(std::string const& before, std::string const& now);

}  // namespace cayspin::inline v0_2::io
