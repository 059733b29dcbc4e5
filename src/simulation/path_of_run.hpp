// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_path.hpp"
#include "scene_run.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <variant>

namespace cayspin::simulation {

/// An end of a path: a file of a kind that initial.file accepts, or the vectors of all sites.
struct EndOfPath {
  std::string name;  // for messages
  std::variant<std::filesystem::path, io::HostVectors> state;
};

/// Finds a minimum energy path between two states, or from one state if options.modes is set, in
/// the scene, space and precision of a run. `to` is ignored if options.modes is set. The run's own
/// spins do not change. `interrupted` is polled between steps of the search. Throws what
/// require_path, require_memory and find_scene_path throw, and UsageError for an end that is not a
/// state of the scene.
ScenePath path_of_run(SceneRun const& run, EndOfPath const& from,
                      std::optional<EndOfPath> const& to, ScenePathOptions options,
                      std::function<bool()> const& interrupted, std::string const& git_commit);

}  // namespace cayspin::simulation
