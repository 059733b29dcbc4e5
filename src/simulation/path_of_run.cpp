// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "path_of_run.hpp"

#include "failure.hpp"
#include "interrupt_poll.hpp"
#include "turn.hpp"

#include <fmt/format.h>

#include <array>
#include <optional>
#include <string_view>
#include <vector>

namespace cayspin::simulation {
namespace {

/// Returns the scene with an end of the path as its start.
io::Scene scene_from(io::Scene scene, EndOfPath const& end) {
  if (auto const* const file = std::get_if<std::filesystem::path>(&end.state)) {
    scene.initial = io::FileStart{std::filesystem::absolute(*file)};
    return scene;
  }
  auto const& vectors = std::get<io::HostVectors>(end.state);
  auto const& [nx, ny, nz] = scene.lattice.shape;
  if (vectors.shape != std::array{nz, ny, nx})
    throw UsageError(fmt::format("{} of shape ({}, {}, {}, 3); accepted: ({}, {}, {}, 3)", end.name,
                                 vectors.shape[0], vectors.shape[1], vectors.shape[2], nz, ny, nx));
  scene.initial =
      io::GivenStart{std::make_shared<std::vector<double> const>(packed<double>(vectors))};
  return scene;
}

/// Returns the spins at an end of the path. Errors name the end instead of a scene's key.
std::vector<double> spins_of(io::Scene const& scene, EndOfPath const& end) {
  try {
    auto const from = scene_from(scene, end);
    io::check_files(from);
    return io::initial_spins(from);
  } catch (io::SceneError const& error) {
    std::string_view const line = error.what();
    for (std::string_view const key : {"initial.file: ", "initial.given: "})
      if (auto const at = line.find(key); at != line.npos)
        throw UsageError(fmt::format("{}: {}", end.name, line.substr(at + key.size())));
    throw;
  }
}

}  // namespace

ScenePath path_of_run(SceneRun const& run, EndOfPath const& from,
                      std::optional<EndOfPath> const& to, ScenePathOptions options,
                      std::function<bool()> const& interrupted, std::string const& git_commit) {
  Turn const turn;
  auto const& scene = run.scene();
  require_path(scene, options);
  require_memory(scene, make_plan_of_path(scene, run.precision(), options));
  InterruptPoll poll(interrupted);
  options.observer = [&](PathProgress const&) { return poll() ? Next::stop : Next::proceed; };
  auto const end = to && !options.modes ? spins_of(scene, *to) : std::vector<double>();
  return find_scene_path(scene, spins_of(scene, from), end, run.space(), run.precision(), options,
                         git_commit);
}

}  // namespace cayspin::simulation
