// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/path.hpp"
#include "plan.hpp"
#include "precision.hpp"

#include <cayspin/path/found.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation {

/// Options of a search for a path, in the units of the scene.
struct ScenePathOptions {
  std::int64_t images = 16;
  double torque = 1e-6;  // bound on max |m x H| at the ends and the saddles
  std::int64_t evaluations = 1000000;
  bool rates = false;
  std::optional<std::int64_t> modes = {};  // modes to climb along, if only one end is known
  std::function<Next(PathProgress const&)> observer = {};
};

/// Largest number of sites for rates, which need several matrices of (2 * sites)^2 numbers.
inline constexpr std::int64_t most_sites_for_rates = 4096;

/// Throws io::SceneError for scenes that have no minimum energy path or are too large for rates,
/// and UsageError for invalid options, with a message that begins with the option's name.
void require_path(io::Scene const& scene, ScenePathOptions const& options);

/// Plans the memory of a search for a path. Throws like make_plan_to_relax.
Plan make_plan_of_path(io::Scene const& scene, Precision precision,
                       ScenePathOptions const& options);

/// A minimum energy path, and why the search for it ended.
struct ScenePath {
  PathEnd end;
  io::Path path;
  std::string rates_failed = {};  // why a converged path has no rates, or empty
  bool needs_images = false;      // unsettled because a saddle is missing between its images
};
/// Finds a minimum energy path between two states, each given as sites x 3 numbers in the order of
/// io::initial_spins. If options.modes is set, ignores `to`, and finds the lowest saddle to which
/// these modes of `from` lead, and the path over it (lowest_escape). Fills all members of the path
/// except `from` and `to`. Throws io::SceneError if a frozen spin differs between the states, and
/// NumbersFailed for a field that is not finite.
ScenePath find_scene_path(io::Scene const& scene, std::vector<double> const& from,
                          std::vector<double> const& to, std::string const& space,
                          Precision precision, ScenePathOptions const& options,
                          std::string const& git_commit);

}  // namespace cayspin::simulation
