// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "cayspin_git_commit.hpp"
#include "command.hpp"
#include "describe.hpp"
#include "io/checkpoint.hpp"
#include "io/notes.hpp"
#include "run_watch.hpp"
#include "simulation/checkpoint_of_ranks.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/parts.hpp"
#include "simulation/plan.hpp"
#include "simulation/restart.hpp"
#include "simulation/text.hpp"
#include "trade/resolved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program {
namespace {

struct RunOptions : DeviceOptions {
  std::optional<std::filesystem::path> restart;
  std::optional<std::string> ranks;  // "y,z"
  Listener listener = Listener::user;
};

void require_one_rank(io::Scene const& scene, Plan const& plan, Ranks const& ranks) {
  if (ranks.many() && plan.variant.ghosts == 0)
    throw io::scene_error(scene, "integrator.method",
                          "runs on one rank alone; accepted: one rank, or another method");
}

// What is refused, with the option that names the file.
template <class Work>
auto as_restart(Work const& work) {
  try {
    return work();
  } catch (UsageError const& error) {
    throw UsageError(std::string("--restart ") + error.what());
  }
}

Restart restart_of(EarlierRun left, io::Scene const& scene, Plan const& plan,
                   RunOptions const& options) {
  auto const output = output_file(scene, options.output);
  return as_restart([&] {
    Restart restart(std::move(left), scene, plan, options.precision, scene.integrator.steps);
    std::error_code ignored;
    for (auto const& file : restart.files())
      for (auto const& written : {output, io::checkpoint_beside(output)})
        if (std::filesystem::equivalent(file, written, ignored))
          throw UsageError(
              fmt::format("{}: the run would write into it; accepted: another file for --output",
                          file.string()));
    return restart;
  });
}

std::vector<double> start_of(io::Scene const& scene, Lattice const& lattice,
                             Restart const* restart) {
  auto const own = own_sites(lattice);
  // An expression that fails at one site has to end all ranks, which later wait for each other.
  io::occupied(scene, own);
  io::frozen(scene, own);
  if (!restart) return io::initial_spins(scene, own);
  return as_restart([&] { return restart->spins(scene, own); });
}

template <class Real, class Space>
int run_on(io::Scene const& typed, io::Scene const& scene, Plan const& plan,
           RunOptions const& options, Restart const* restart, Ranks& ranks) {
  Kokkos::Timer const clock;
  auto times = plan.times;
  if (restart) times.first = restart->step();
  RunningScene<Real, Space> simulation(
      scene, plan, times, ranks.together([&] { return start_of(scene, plan.lattice, restart); }));

  auto const path = output_file(scene, options.output);
  auto const checkpoint_path = io::checkpoint_beside(path);
  auto const resolved = typed.integrator.method->automatic ? scene.text : std::string();
  Watch<Real, Space> watch(
      scene, simulation,
      [&] {
        auto header = run_header(typed, options.precision, chosen_space(options.space),
                                 threads_of(simulation.exec), CAYSPIN_GIT_COMMIT);
        header.resolved_scene = resolved;
        auto files = run_output_options(scene, options.overwrite);
        files.most_planes = ranks.planes_at_once(plan.lattice);
        return open_output(path, header, files);
      },
      ranks.is_first() ? options.listener : Listener::nobody, ranks);
  auto const store_checkpoint = [&](Step const& step) {
    std::optional<io::CheckpointWriter> file;
    ranks.together([&] {
      if (!ranks.is_first()) return;
      auto header =
          checkpoint_header(typed, options.precision, step.number, step.time * scene.units.time);
      header.resolved_scene = resolved;
      file.emplace(checkpoint_path, header);
    });
    CheckpointFromRanks checkpoint(ranks, plan.lattice, file ? &*file : nullptr);
    bool continues = true;
    simulation.exchange(checkpoint, continues);
    checkpoint.commit();
  };
  watch.store_checkpoints_by(store_checkpoint);
  if (restart && restart->memory()) {
    CheckpointForRank part(plan.lattice, *restart->memory());
    simulation.exchange(part, simulation.times.continues);
  }

  auto const kept = [&] {
    if (!watch.file()) return std::string("no frame was written");
    auto const& frame = watch.last_frame();
    return fmt::format("the last good frame is {} in {} (step {}, t = {})",
                       watch.file()->frames() - 1, path.string(), frame.step,
                       time_text(scene.units, frame.time));
  };
  auto const fail = [&](std::string const& why) {
    ranks.together([&] {
      if (ranks.is_first())
        throw NumbersFailed(fmt::format("{}: {}; {}", scene.path.string(), why, kept()));
    });
  };
  auto [summary, failure] = simulation.advance(watch);
  // The library's own messages, which know nothing of the scene's units.
  if (failure && scene.units.si)
    *failure += fmt::format(" (times in units of {:.6g} s)", scene.units.time);
  io::RunCost const cost{summary.evaluations, clock.seconds(), summary.step_seconds};
  bool const whole = !failure && !watch.failure() && !watch.interrupted();
  auto const frames = ranks.together([&]() -> std::int64_t {
    if (!watch.file()) return 0;
    auto const written = watch.file()->frames();
    whole ? watch.file()->finish(cost) : watch.file()->close(cost);
    return written;
  });
  if (failure) fail(*failure);
  bool const has_file = ranks.any({watch.file().has_value(), false})[0];
  if (has_file && !watch.failure() && !scene.output.checkpoint_every.is_never()) {
    // Of a run without memory the last frame says it all.
    auto const& end = watch.last_frame();
    if (remembers(scene, plan))
      store_checkpoint({end.step, end.time, plan.times.dt, true});
    else if (ranks.is_first())
      std::filesystem::remove(checkpoint_path);
  }
  if (ranks.is_first()) watch.progress().close(summary, frames, path.string());
  if (watch.failure()) fail(*watch.failure());
  if (watch.at_saddle() && ranks.is_first() && options.listener == Listener::user)
    fmt::print(
        "{}: ended at a saddle or a maximum of the energy: max |m x H| is below "
        "integrator.until_torque, but the energy has a direction down; accepted: another "
        "start, or cayspin relax\n",
        scene.path.string());
  if (!watch.interrupted()) return Status::done;
  if (ranks.is_first())
    fmt::print(stderr, "{}: interrupted after step {} of {}; {}\n", scene.path.string(),
               times.first + summary.steps, plan.times.steps, kept());
  return Status::interrupted;
}

// The scene as it was typed, which the ranks must agree on, and all that can be refused by it
// alone.
io::Scene typed_scene(RunOptions const& options, Ranks& ranks) {
  auto typed = ranks.together([&] {
    auto scene = io::with_shape_of_start(io::read_scene(options.scene, options.overrides));
    output_file(scene, options.output);
    io::check_files(scene);
    return scene;
  });
  bool const alike = ranks.same(typed.text + std::string(to_string(options.precision)) +
                                options.restart.value_or("").string());
  ranks.together([&] {
    if (!alike && ranks.is_first())
      throw UsageError("the ranks were given different scenes or options; accepted: the same");
  });
  return typed;
}

// The method "auto" is chosen by the first rank, for all.
io::Scene with_method(io::Scene const& typed, EarlierRun const* left, RunOptions const& options,
                      std::string const& space, Ranks& ranks) {
  auto const as_before =
      left ? trade::with_method_of(typed, left->scene_text(), left->resolved_scene())
           : std::nullopt;
  if (as_before) return *as_before;
  if (!typed.integrator.method->automatic) return typed;
  bool const silent = options.listener != Listener::user;
  std::optional<io::Scene> scene;
  ranks.together([&] {
    TrialProgress progress(silent, true);
    if (ranks.is_first()) scene = trade::with_method(typed, space, options.precision, &progress);
  });
  std::string text = scene ? scene->text : std::string();
  ranks.tell(text);
  return scene ? *scene : io::parse_scene(text, typed.path);
}

std::optional<int> threads_of_rank(RunOptions const& options, Ranks const& ranks) {
  if (options.threads || !ranks.many() || std::getenv("OMP_NUM_THREADS")) return options.threads;
  return std::max(1, expected_threads() / ranks.on_this_machine());
}

int run(RunOptions const& options, Ranks& ranks) {
  auto const typed = typed_scene(options, ranks);
  auto const space = ranks.together([&] { return chosen_space(options.space); });
  KokkosSession const kokkos(space, threads_of_rank(options, ranks), options.device);
  auto left = ranks.together(
      [&] { return options.restart ? std::make_unique<EarlierRun>(*options.restart) : nullptr; });
  auto const scene = with_method(typed, left.get(), options, space, ranks);
  if (typed.integrator.method->automatic && options.listener == Listener::user && ranks.is_first())
    fmt::print("method auto: {}, {}\n", describe_method(scene),
               scene.integrator.tolerance
                   ? fmt::format("tolerance {:.3g}", *scene.integrator.tolerance)
                   : "dt " + time_text(scene.units, scene.integrator.dt));
  auto plan = ranks.together([&] { return make_plan(scene, options.precision); });
  auto const depth = depth_of_parts(scene, plan);
  auto const parts = ranks.together([&] {
    require_one_rank(scene, plan, ranks);
    return ranks.division(plan.lattice, depth, options.ranks);
  });
  auto const part = ranks.divide(plan.lattice, depth, parts);
  if (part.none) return Status::done;
  keep_part(plan, scene, options.precision, part.local, ranks.planes_at_once(part.local));
  auto const restart = ranks.together([&]() -> std::unique_ptr<Restart> {
    require_memory(scene, plan, ranks.on_this_machine());
    if (auto const warning = dt_warning(scene, plan); warning && ranks.is_first())
      fmt::print(stderr, "warning: {}\n", *warning);
    if (ranks.is_first()) warn_of_notes(scene);
    if (!left) return nullptr;
    auto from = std::make_unique<Restart>(restart_of(std::move(*left), scene, plan, options));
    if (auto const& warning = from->warning(); warning && ranks.is_first())
      fmt::print(stderr, "warning: --restart {}\n", *warning);
    return from;
  });
  catch_signals();
  return in_space(space, options.precision, [&]<class Real, class Space>() {
    return run_on<Real, Space>(typed, scene, plan, options, restart.get(), ranks);
  });
}

}  // namespace

Command add_run(CLI::App& program) {
  auto const options = std::make_shared<RunOptions>();
  auto* const command =
      program.add_subcommand("run", "Run a scene and write its trajectory (HDF5)");
  add_device_options(*command, *options);
  add_ranks_option(*command, options->ranks, "Parts of the lattice along y and z, on ranks of MPI");
  command->add_option("--restart", options->restart,
                      "Go on from the last frame of a trajectory file");
  command->add_flag_callback(
      "--quiet", [options] { options->listener = Listener::nobody; }, "No progress");
  command
      ->add_flag_callback("--report-progress", [options] { options->listener = Listener::program; })
      ->group("");  // what `sweep` starts its runs with
  return {command, [options](Ranks& ranks) { return run(*options, ranks); }};
}

}  // namespace cayspin::program
