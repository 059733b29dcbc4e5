// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_path.hpp"
#include "scene_run.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <variant>

namespace cayspin::simulation {

/// An end of a path: a file, as initial.file of a scene takes it, or vectors of all sites.
struct EndOfPath {
  std::string name;  // for messages
  std::variant<std::filesystem::path, io::HostVectors> state;
};

/// A path of least energy between two states in the scene, space and precision of a run, whose own
/// spins stay as they are. `interrupted` is asked after each step of the search. Throws as
/// require_path and find_scene_path do, and UsageError for an end that is no state of the scene.
ScenePath path_of_run(SceneRun const& run, EndOfPath const& from, EndOfPath const& to,
                      ScenePathOptions options, std::function<bool()> const& interrupted,
                      std::string const& git_commit);

}  // namespace cayspin::simulation
