// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

namespace cayspin::inline v0_2::io {

/// Reads a scene for `cayspin relax`: like read_scene, but [integrator] is optional, and
/// field.applied may be a list of fields (Field::applied_in_turn). Throws SceneError, also for
/// rigid bodies and fields that depend on t.
Scene read_scene_to_relax(std::filesystem::path const& path,
                          std::vector<std::string> const& overrides = {});

/// Parses a text in memory like read_scene_to_relax.
Scene parse_scene_to_relax(std::string text, std::filesystem::path const& name,
                           std::vector<std::string> const& overrides = {}, Given given = {});

/// Reads a scene that only `cayspin relax` accepts like read_scene_to_relax, any other one like
/// read_scene.
Scene read_scene_to_run_or_relax(std::filesystem::path const& path,
                                 std::vector<std::string> const& overrides = {}, Given given = {});

/// Parses a text in memory like read_scene_to_run_or_relax.
Scene parse_scene_to_run_or_relax(std::string text, std::filesystem::path const& name,
                                  std::vector<std::string> const& overrides = {}, Given given = {});

/// Returns true if the scene has a table [integrator]. If not, Scene::integrator has no meaning.
bool has_integrator(Scene const& scene);

/// Returns true if only `cayspin relax` accepts the scene: it has no [integrator], or a list of
/// fields.
bool is_to_relax(Scene const& scene);

/// Returns the [field] of each equilibrium that the scene asks for: one, or those of its list.
std::vector<Field> fields_in_turn(Scene const& scene);

}  // namespace cayspin::inline v0_2::io
