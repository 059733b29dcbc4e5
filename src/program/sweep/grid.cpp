// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "grid.hpp"

#include "cayspin_git_commit.hpp"
#include "io/key_path.hpp"
#include "io/notes.hpp"
#include "io/stages.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/plan.hpp"
#include "simulation/scene_minimizer.hpp"
#include "simulation/single_terms.hpp"

#include <cayspin/version.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <utility>

namespace cayspin::program::sweep {
namespace {

constexpr double most_runs = 1e5;
// Starts are checked before the first run, up to this many sites in all.
constexpr std::int64_t most_checked = 20'000'000;

// Returns true if two keys are equal, or if one is a table that contains the other. Both may be
// followed by =VALUE, which is ignored.
bool overlap(std::string const& a, std::string const& b) {
  auto const path = [](std::string const& assignment) {
    return io::plain_path(std::string_view(assignment).substr(0, assignment.find('='))) + '.';
  };
  auto const first = path(a), second = path(b);
  return first.starts_with(second) || second.starts_with(first);
}

std::vector<io::SweptKey> read_keys(SweepOptions const& options) {
  std::vector<io::SweptKey> keys;
  double runs = 1;
  for (auto const& assignment : options.over) {
    auto key = io::read_swept_key(assignment);
    auto const refuse = [&](std::string const& why) {
      throw UsageError(fmt::format("--over {}: {}", key.key, why));
    };
    for (auto const& other : keys) {
      if (other.key == key.key) refuse("it is named twice; accepted: one --over with all values");
      if (overlap(other.key, key.key))
        refuse(fmt::format("--over {} has it too; accepted: one of them", other.key));
    }
    if (std::ranges::any_of(options.overrides,
                            [&](auto const& override) { return overlap(override, key.key); }))
      refuse("--set has it too; accepted: one of them");
    if (overlap(key.key, "output.file"))
      refuse("all runs go into the file that --output names; accepted: other keys");
    runs *= static_cast<double>(key.values.size());
    keys.push_back(std::move(key));
  }
  if (runs > most_runs)
    throw UsageError(fmt::format("--over: {:.3g} runs; accepted: at most {:g}", runs, most_runs));
  return keys;
}

// Searches fields for features in time only if the scene sets refuse_unstable, because each run
// repeats this search.
Plan plan_of(io::Stage const& stage, Precision precision) {
  auto const& scene = stage.scene;
  if (stage.relax) return make_plan_to_relax(scene, precision);
  auto const no_features = std::make_shared<TimeFeatures const>();
  auto plan = make_plan(scene, precision, scene.integrator.refuse_unstable ? nullptr : no_features);
  dt_warning(scene, plan);  // throws if dt is too large and the scene sets refuse_unstable
  return plan;
}

// Refuses files beside a run's own file: the sweep's file would not have their contents.
void require_one_file(io::Scene const& scene) {
  for (auto const& [key, is_set] :
       {std::pair{"output.xdmf", scene.output.xdmf}, {"output.table", scene.output.table}})
    if (is_set)
      throw io::scene_error(scene, key,
                            "true: a sweep writes one file, with the samples of all runs; "
                            "accepted: false");
}

// The values of a run are passed to its scene as overrides, so messages call them --set. Replaces
// that by --over.
std::string naming_over(std::string message, std::vector<std::string> const& overrides) {
  constexpr std::string_view set = "--set ";
  for (auto const& override : overrides)
    if (message.starts_with(fmt::format("{}{}: ", set, override)))
      return message.replace(0, set.size(), "--over ");
  return message;
}

}  // namespace

std::string values_text(io::SweepHeader const& header, std::int64_t run) {
  return fmt::format("{}", fmt::join(header.overrides(run), " "));
}

Grid make_grid(SweepOptions const& options) {
  Grid grid;
  auto& header = grid.header;
  header.keys = read_keys(options);
  header.precision = to_string(options.precision);
  header.space = chosen_space(options.space);
  require_threads(header.space, options.threads);
  header.cayspin_version = CAYSPIN_VERSION_STRING;
  header.git_commit = CAYSPIN_GIT_COMMIT;
  std::int64_t checked = 0;
  for (std::int64_t run = 0; run < header.runs(); ++run) {
    auto overrides = options.overrides;
    std::ranges::copy(header.overrides(run), std::back_inserter(overrides));
    try {
      auto const scene = io::with_shape_of_start(io::read_scene(options.scene, overrides));
      output_file(scene, options.output);
      io::check_files(scene);
      if (scene.output.sync)
        throw io::scene_error(scene, "output.sync",
                              "true: a sweep is not protected against power cuts; accepted: false");
      require_one_file(scene);
      std::int64_t steps = 0;
      auto const stages = io::stages_of(scene);
      for (auto const& stage : stages) {
        require_same_terms(stages[0].scene, stage.scene);
        steps += stage.relax ? 0 : stage.scene.integrator.steps;
        if (scene.integrator.method->automatic) continue;
        auto const plan = plan_of(stage, options.precision);
        if (plan.memory.total() <= grid.largest) continue;
        require_memory(stage.scene, plan);
        grid.largest = plan.memory.total();
      }
      checked += io::sites(scene);
      if (checked <= most_checked) io::initial_spins(scene);
      grid.texts.push_back(scene.text);
      grid.costs.push_back(static_cast<double>(steps) * static_cast<double>(io::sites(scene)));
    } catch (io::SceneError const& error) {
      auto const message = naming_over(error.what(), header.overrides(run));
      if (header.runs() == 1) throw io::SceneError(message);
      throw io::SceneError(fmt::format("with {}: {}", values_text(header, run), message));
    }
  }
  header.scene_text = grid.texts.front();
  return grid;
}

}  // namespace cayspin::program::sweep
