// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "command.hpp"
#include "describe.hpp"
#include "io/checkpoint.hpp"
#include "io/notes.hpp"
#include "io/stages.hpp"
#include "kokkos_of_command.hpp"
#include "run_ensemble.hpp"
#include "run_stages.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/message.hpp"
#include "simulation/parts.hpp"
#include "simulation/plan.hpp"
#include "simulation/restart.hpp"
#include "simulation/single_terms.hpp"
#include "simulation/text.hpp"
#include "trade/resolved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program {
namespace {

void require_one_rank(io::Stage const& stage, Plan const& plan, Ranks const& ranks) {
  auto const& scene = stage.scene;
  if (ranks.many() && stage.relax)
    throw io::scene_error(scene, fmt::format("stage[{}].relax", scene.begin.stage - 1),
                          "runs only on one rank; accepted: one rank");
  if (ranks.many() && plan.variant.ghosts == 0)
    throw io::scene_error(scene, "integrator.method",
                          "runs only on one rank; accepted: one rank, or another method");
}

Restart restart_of(EarlierRun left, io::Stage const& stage, Plan const& plan,
                   RunOptions const& options) {
  auto const& scene = stage.scene;
  auto const end = stage.relax ? std::numeric_limits<std::int64_t>::max() : plan.times.steps;
  auto const output = output_file(scene, options.output);
  return as_restart([&] {
    Restart restart(std::move(left), scene, plan, options.precision, end);
    for (auto const& file : restart.files()) require_not_written(file, output);
    return restart;
  });
}

// Reads the scene as typed, which may have the method "auto", and checks its files. Throws
// UsageError if the ranks were given different scenes or options.
io::Scene typed_scene(RunOptions const& options, Ranks& ranks) {
  auto typed = ranks.together([&] {
    auto scene = io::with_shape_of_start(io::read_scene(options.scene, options.overrides));
    output_file(scene, options.output);
    io::check_files(scene);
    return scene;
  });
  require_alike(typed, options,
                options.restart.value_or("").string() + '\n' + options.ranks.value_or(""), ranks);
  return typed;
}

// Returns the scene with a method in place of "auto": that of the earlier run if these ranks can
// run it, or the one that the first rank chooses for all. Returns any other scene unchanged.
io::Scene with_method(io::Scene const& typed, EarlierRun const* left, RunOptions const& options,
                      std::string const& space, Ranks& ranks) {
  auto const as_before = ranks.together([&] {
    return left ? trade::with_method_of(typed, left->scene_text(), left->resolved_scene(),
                                        ranks.many())
                : std::nullopt;
  });
  if (as_before) return *as_before;
  if (!typed.integrator.method->automatic) return typed;
  bool const silent = options.listener != Listener::user;
  std::optional<io::Scene> scene;
  ranks.together([&] {
    TrialProgress progress(silent, true);
    if (ranks.is_first())
      scene = trade::with_method(typed, space, options.precision, ranks.many(), &progress);
  });
  std::string text = scene ? scene->text : std::string();
  ranks.tell(text);
  return scene ? *scene : io::parse_scene(text, typed.path);
}

Plan plan_of(io::Stage const& stage, Precision precision) {
  return stage.relax ? make_plan_to_relax(stage.scene, precision)
                     : make_plan(stage.scene, precision);
}

// Returns all stages. A stage that the earlier run has completed has no plan.
std::vector<PlannedStage> planned_stages(io::Scene const& scene, EarlierRun* left,
                                         RunOptions const& options, Ranks& ranks) {
  return ranks.together([&] {
    auto stages = io::stages_of(scene);
    for (auto const& stage : stages) require_same_terms(stages[0].scene, stage.scene);
    auto const begin = left ? as_restart([&] { return left->enter(stages); }) : io::StageBegin{};
    auto const first = static_cast<std::size_t>(begin.stage);
    stages[first].scene.begin = begin;
    io::put_begins(stages, first);
    std::vector<PlannedStage> planned;
    for (std::size_t n = 0; n < stages.size(); ++n) {
      auto& stage = planned.emplace_back(std::move(stages[n]), std::nullopt);
      if (n >= first) stage.plan.emplace(plan_of(stage.stage, options.precision));
    }
    return planned;
  });
}

// Returns how many rows and planes the parts need from their neighbours in any stage. The start
// takes no steps, but its field is evaluated.
mpi::Depth depth_of_all(std::vector<PlannedStage> const& stages) {
  mpi::Depth depth(0);
  for (auto const& [stage, plan] : stages) {
    if (!plan || stage.relax) continue;
    int const ghosts = is_start(stage) ? 1 : plan->variant.ghosts;
    auto const needed = depth_of_parts(stage.scene, plan->lattice, ghosts);
    depth.y = std::max(depth.y, needed.y);
    depth.z = std::max(depth.z, needed.z);
  }
  return depth;
}

void warn(std::vector<PlannedStage> const& stages) {
  std::vector<std::string> notes;
  for (auto const& [stage, plan] : stages) {
    if (!plan) continue;
    if (auto const warning = dt_warning(stage.scene, *plan); warning && !stage.relax)
      print_message("warning: {}\n", *warning);
    for (auto const& note : io::notes(stage.scene))
      if (std::ranges::find(notes, note) == notes.end()) notes.push_back(note);
  }
  for (auto const& note : notes) print_message("warning: {}\n", note);
}

int run(RunOptions const& options, Ranks& ranks) {
  auto const typed = typed_scene(options, ranks);
  if (typed.ensemble.there()) {
    ranks.together([&] { require_divisible(typed, options.ranks); });
    return run_ensemble(typed, options, ranks);
  }
  auto const space = ranks.together([&] { return chosen_space(options.space); });
  auto const kokkos = ranks.together([&] {
    return std::make_unique<KokkosOfCommand>(space, threads_for(options, space, ranks),
                                             options.device);
  });
  auto left = ranks.together(
      [&] { return options.restart ? std::make_unique<EarlierRun>(*options.restart) : nullptr; });
  auto const scene = with_method(typed, left.get(), options, space, ranks);
  if (typed.integrator.method->automatic && options.listener == Listener::user && ranks.is_first())
    fmt::print("method auto: {}, {}\n", describe_method(scene),
               scene.integrator.tolerance
                   ? fmt::format("tolerance {:.3g}", *scene.integrator.tolerance)
                   : "dt " + time_text(scene.units, scene.integrator.dt));
  auto stages = planned_stages(scene, left.get(), options, ranks);
  auto const& first = *std::ranges::find_if(stages, [](auto& one) { return one.plan.has_value(); });
  auto const& lattice = first.plan->lattice;
  auto const depth = ranks.together([&] { return depth_of_all(stages); });
  auto const parts = ranks.together([&] {
    for (auto const& [stage, plan] : stages)
      if (plan) require_one_rank(stage, *plan, ranks);
    return ranks.division(lattice, depth, options.ranks);
  });
  // Ranks without a part must survive an interrupt, too: a launcher ends all ranks if one dies.
  catch_signals();
  auto const part = ranks.divide(lattice, depth, parts);
  if (part.none) return Status::done;
  auto const on_part = [&](io::Stage const& stage, Plan plan) {
    keep_part(plan, stage.scene, options.precision, part.local, ranks.planes_at_once(part.local));
    if (stage.relax)
      plan.memory.work = make_plan_to_relax(stage.scene, options.precision).memory.work;
    return plan;
  };
  for (auto& [stage, plan] : stages)
    if (plan) plan.emplace(on_part(stage, *plan));
  auto const restart = ranks.together([&]() -> std::unique_ptr<Restart> {
    for (auto const& [stage, plan] : stages)
      if (plan) require_memory(stage.scene, *plan, ranks.on_this_machine());
    if (ranks.is_first()) warn(stages);
    if (!left) return nullptr;
    auto from =
        std::make_unique<Restart>(restart_of(std::move(*left), first.stage, *first.plan, options));
    if (auto const& warning = from->warning(); warning && ranks.is_first())
      print_message("warning: --restart {}\n", *warning);
    return from;
  });
  auto const resolved = typed.integrator.method->automatic ? scene.text : std::string();
  return in_space(space, options.precision, [&]<class Real, class Space>() {
    return RunOfStages<Real, Space>(
               typed, resolved, std::move(stages),
               [&](io::Stage const& stage) {
                 return on_part(stage, plan_of(stage, options.precision));
               },
               options, restart.get(), ranks)
        .run();
  });
}

}  // namespace

Command add_run(CLI::App& program) {
  auto const options = std::make_shared<RunOptions>();
  auto* const command =
      program.add_subcommand("run", "Run a scene and write its trajectory (HDF5)");
  add_device_options(*command, *options);
  add_ranks_option(*command, options->ranks,
                   "Number of parts of the lattice along y and z, one for each MPI rank");
  command->add_option("--restart", options->restart,
                      "Go on from the last frame of a trajectory file");
  command->add_flag_callback(
      "--quiet", [options] { options->listener = Listener::nobody; }, "No progress");
  command
      ->add_flag_callback("--report-progress", [options] { options->listener = Listener::program; })
      ->group("");  // for runs started by `sweep`
  return {command, [options](Ranks& ranks) { return run(*options, ranks); }};
}

}  // namespace cayspin::program
