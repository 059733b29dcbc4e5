// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/io/scene.hpp>

namespace cayspin::io {

/// Reads a scene for `cayspin relax`: as read_scene does, but [integrator] may be missing, and
/// field.applied may be a list of fields (Field::applied_in_turn). Throws SceneError, also for
/// rigid bodies and fields that depend on t.
Scene read_scene_to_relax(std::filesystem::path const& path,
                          std::vector<std::string> const& overrides = {});

}  // namespace cayspin::io
