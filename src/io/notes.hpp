// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <vector>

namespace cayspin::inline v0_1::io {

/// Lists each key of a scene that acts nowhere, or that does not go with another key, in one line,
/// "FILE:LINE: key: message". `cayspin check` prints these, and `run` and `relax` warn of them.
/// Opens the files with numbers of sites. Throws SceneError.
std::vector<std::string> notes(Scene const& scene);

/// The scene with lattice.occupied = { file = .. } of its start where that file has zero vectors
/// and the scene does not say where spins are; otherwise the scene. Reads the file. Throws
/// SceneError.
Scene with_shape_of_start(Scene scene);

}  // namespace cayspin::inline v0_1::io
