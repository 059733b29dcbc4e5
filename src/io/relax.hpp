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

/// Reads a scene for which is_to_relax() is true like read_scene_to_relax, any other one like
/// read_scene.
Scene read_scene_to_run_or_relax(std::filesystem::path const& path,
                                 std::vector<std::string> const& overrides = {}, Given given = {});

/// Parses a text in memory like read_scene_to_run_or_relax.
Scene parse_scene_to_run_or_relax(std::string text, std::filesystem::path const& name,
                                  std::vector<std::string> const& overrides = {}, Given given = {});

/// Returns true if the scene has a table [integrator]. If not, Scene::integrator has no meaning.
bool has_integrator(Scene const& scene);

/// Returns true for a scene that cannot be run, but only searched for equilibria: it has no
/// [[stage]], and either lacks [integrator] or has a list of fields.
bool is_to_relax(Scene const& scene);

/// Returns [field] for each equilibrium that the scene asks for: once, or with each of the listed
/// applied fields.
std::vector<Field> fields_in_turn(Scene const& scene);

}  // namespace cayspin::inline v0_2::io
