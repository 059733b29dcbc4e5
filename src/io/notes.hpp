// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Lists each key of a scene that has no effect, or that does not go with another key, in one line,
/// "FILE:LINE: key: message". `cayspin check` prints these notes, `run` and `relax` print them as
/// warnings. Opens the files with site-dependent numbers. Throws SceneError.
std::vector<std::string> notes(Scene const& scene);

/// Returns the scene, with lattice.occupied = { file = .. } set to its start file if that file has
/// zero vectors and the scene does not say which sites are occupied. Reads the file. Throws
/// SceneError.
Scene with_shape_of_start(Scene scene);

}  // namespace cayspin::inline v0_2::io
