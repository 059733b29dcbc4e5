// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

namespace cayspin::inline v0_1::io {

/// Reads a scene for `cayspin relax`: as read_scene does, but [integrator] may be missing, and
/// field.applied may be a list of fields (Field::applied_in_turn). Throws SceneError, also for
/// rigid bodies and fields that depend on t.
Scene read_scene_to_relax(std::filesystem::path const& path,
                          std::vector<std::string> const& overrides = {});

/// Reads a scene that only `cayspin relax` can take as read_scene_to_relax does, any other one as
/// read_scene does.
Scene read_scene_to_run_or_relax(std::filesystem::path const& path,
                                 std::vector<std::string> const& overrides = {}, Given given = {});

/// The same for a text in memory.
Scene parse_scene_to_run_or_relax(std::string text, std::filesystem::path const& name,
                                  std::vector<std::string> const& overrides = {}, Given given = {});

/// Has the scene a table [integrator]? What stands in Scene::integrator of one without means
/// nothing.
bool has_integrator(Scene const& scene);

/// Can only `cayspin relax` take the scene: for want of [integrator], or for its list of fields?
bool is_to_relax(Scene const& scene);

/// The [field] of each state of rest that the scene asks for: one, or those of its list.
std::vector<Field> fields_in_turn(Scene const& scene);

}  // namespace cayspin::inline v0_1::io
