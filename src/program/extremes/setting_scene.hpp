// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "choice.hpp"
#include "situation.hpp"

namespace cayspin::program::extremity {

/// The scene of a setting, typed into a file and read like any other. Throws io::SceneError.
io::Scene scene_of(Choice const& choice, Setting const& setting);

}  // namespace cayspin::program::extremity
