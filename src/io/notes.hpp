// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Returns lines, "FILE:LINE: key: message", about keys of a scene that have no effect, do not fit
/// another key, or have values that look as if typed in other units; also about a start file whose
/// zero vectors mean sites without a spin. `cayspin check` prints these notes, `run` and
/// `relax` print them as warnings. Reads some of the files that the scene names. Throws SceneError.
std::vector<std::string> notes(Scene const& scene);

/// Returns the scene with lattice.occupied = { file = START }, where START is the start file, so
/// that sites with a zero vector in that file have no spin. The scene is unchanged if it has rigid
/// bodies, if its start is not a file, if it has lattice.occupied already, or if none or all of the
/// vectors are zero. Reads the start file. Throws SceneError.
Scene with_shape_of_start(Scene scene);

}  // namespace cayspin::inline v0_2::io
