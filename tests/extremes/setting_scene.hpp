// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "integrator.hpp"
#include "situation.hpp"

namespace cayspin::extremes {

/// Returns the scene of a setting. It is written to a file and read like any other scene. Throws
/// io::SceneError if it is refused.
io::Scene scene_of(Integrator const& integrator, Setting const& setting);

}  // namespace cayspin::extremes
