// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "cayspin_git_commit.hpp"
#include "command.hpp"
#include "files/file_beside.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/restart.hpp"
#include "simulation/run_state.hpp"
#include "simulation/text.hpp"
#include "trade/resolved.hpp"
#include "watch.hpp"

#include <cayspin/io/checkpoint.hpp>
#include <cayspin/version.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <optional>

namespace cayspin::program {
namespace {

std::filesystem::path output_file(io::Scene const& scene, RunOptions const& options) {
  if (options.output) return *options.output;
  if (scene.output.file) return *scene.output.file;
  throw io::scene_error(scene, "output.file",
                        "no file to write to; accepted: this key, or --output FILE.h5");
}

void warn_above_stable_dt(io::Scene const& scene, Plan const& plan) {
  auto const reason = dt_warning(plan, scene.units);
  if (!reason) return;
  auto const error = io::scene_error(scene, "integrator.dt", *reason);
  if (scene.integrator.refuse_unstable) throw error;
  fmt::print(stderr, "warning: {}\n", error.what());
}

io::CheckpointHeader checkpoint_header(io::Scene const& typed, io::Scene const& scene,
                                       Precision precision, Step const& step) {
  return {.scene_text = typed.text,
          .resolved_scene = typed.integrator.method->automatic ? scene.text : std::string(),
          .cayspin_version = CAYSPIN_VERSION_STRING,
          .precision = std::string(to_string(precision)),
          .shape = scene.lattice.shape,
          .step = step.number,
          .time = step.time * scene.units.time,
          .si = scene.units.si};
}

Restart restart_of(LeftBehind left, io::Scene const& scene, Plan const& plan,
                   RunOptions const& options) {
  auto const output = output_file(scene, options);
  try {
    Restart restart(std::move(left), scene, plan, options.precision, scene.integrator.steps);
    std::error_code ignored;
    for (auto const& file : restart.files())
      for (auto const& written : {output, io::checkpoint_beside(output)})
        if (std::filesystem::equivalent(file, written, ignored))
          throw UsageError(
              fmt::format("{}: the run would write into it; accepted: another file for --output",
                          file.string()));
    return restart;
  } catch (UsageError const& error) {
    throw UsageError(std::string("--restart ") + error.what());
  }
}

template <class Real, class Space>
int run_on(io::Scene const& typed, io::Scene const& scene, Plan const& plan,
           RunOptions const& options, Restart const* restart) {
  Kokkos::Timer const clock;
  auto times = plan.times;
  if (restart) times.first = restart->step();
  Simulation<Real, Space> simulation(scene, plan.lattice, times,
                                     restart ? restart->spins() : io::initial_spins(scene));
  auto const method = plan.variant.open(&simulation, plan.options);

  auto const path = output_file(scene, options);
  auto const checkpoint_path = io::checkpoint_beside(path);
  Watch<Real, Space> watch(
      scene, simulation.generator, simulation.spins, times.first,
      [&] {
        io::require_free(checkpoint_path, options.overwrite);
        auto const& exec = simulation.exec;
        int const threads = cayspin::detail::is_host_execution<Space> ? exec.concurrency() : 1;
        auto header =
            run_header(typed, options.precision, space_name<Space>(), threads, CAYSPIN_GIT_COMMIT);
        if (typed.integrator.method->automatic) header.resolved_scene = scene.text;
        io::RunOutput file(path, header, run_output_options(scene, options.overwrite));
        std::filesystem::remove(checkpoint_path);
        return file;
      },
      options.listener);
  std::optional<ControlledWatch<Real, Space>> controlled;
  if (scene.integrator.energy_control)
    controlled.emplace(watch, simulation.generator, simulation.spins);
  auto const exchange = [&](Checkpoint& checkpoint, bool& continues) {
    exchange_state(checkpoint, simulation, *method, continues, watch.guard(),
                   controlled ? &controlled->control() : nullptr);
  };
  auto const store_checkpoint = [&](Step const& step) {
    io::CheckpointWriter checkpoint(checkpoint_path,
                                    checkpoint_header(typed, scene, options.precision, step));
    bool continues = true;
    exchange(checkpoint, continues);
    checkpoint.commit();
  };
  watch.store_checkpoints_by(store_checkpoint);
  if (restart && restart->memory()) exchange(*restart->memory(), simulation.times.continues);

  auto const kept = [&] {
    if (!watch.file()) return std::string("no frame was written");
    auto const& frame = watch.last_frame();
    return fmt::format("the last good frame is {} in {} (step {}, t = {})",
                       watch.file()->frames() - 1, path.string(), frame.step,
                       time_text(scene.units, frame.time));
  };
  auto const failed = [&](std::string const& why) {
    return NumbersFailed(fmt::format("{}: {}; {}", scene.path.string(), why, kept()));
  };
  auto [summary, failure] =
      controlled ? simulation.advance(*method, *controlled) : simulation.advance(*method, watch);
  // The library's own messages, which know nothing of the scene's units.
  if (failure && scene.units.si)
    *failure += fmt::format(" (times in units of {:.6g} s)", scene.units.time);
  if (failure) throw failed(*failure);
  if (controlled) summary.evaluations += controlled->evaluations();
  auto const frames = watch.file() ? watch.file()->frames() : 0;
  io::RunCost const cost{summary.evaluations, clock.seconds(), summary.step_seconds};
  bool const whole = !watch.failure() && !watch.interrupted();
  if (watch.file()) whole ? watch.file()->finish(cost) : watch.file()->close(cost);
  if (watch.file() && !watch.failure() && !scene.output.checkpoint_every.is_never()) {
    // Of a run without memory the last frame says it all.
    auto const& end = watch.last_frame();
    if (remembers(scene, plan))
      store_checkpoint({end.step, end.time, plan.times.dt, true});
    else
      std::filesystem::remove(checkpoint_path);
  }
  watch.progress().close(summary, frames, path.string());
  if (watch.failure()) throw failed(*watch.failure());
  if (!watch.interrupted()) return Status::done;
  fmt::print(stderr, "{}: interrupted after step {} of {}; {}\n", scene.path.string(),
             summary.steps, plan.times.steps, kept());
  return Status::interrupted;
}

}  // namespace

int run(RunOptions const& options) {
  auto const typed = io::read_scene(options.scene, options.overrides);
  output_file(typed, options);
  io::check_files(typed);
  auto const space = chosen_space(options.space);
  KokkosSession const kokkos(space, options.threads, options.device);
  bool const silent = options.listener != Listener::user;
  std::optional<LeftBehind> left;
  if (options.restart) left.emplace(*options.restart);
  auto const as_before =
      left ? trade::with_method_of(typed, left->scene_text(), left->resolved_scene())
           : std::nullopt;
  auto const scene = as_before ? *as_before
                               : trade::with_method(typed, space, options.precision,
                                                    trade::TrialProgress(silent, true).on_try());
  if (typed.integrator.method->automatic && options.listener == Listener::user)
    fmt::print("method auto: {}, {}\n", describe_method(scene),
               scene.integrator.tolerance
                   ? fmt::format("tolerance {:.3g}", *scene.integrator.tolerance)
                   : "dt " + time_text(scene.units, scene.integrator.dt));
  auto const plan = make_plan(scene, options.precision);
  require_memory(scene, plan);
  std::optional<Restart> restart;
  if (left) restart.emplace(restart_of(std::move(*left), scene, plan, options));
  Restart const* const from = restart ? &*restart : nullptr;
  warn_above_stable_dt(scene, plan);
  catch_signals();
  return in_space(space, options.precision, [&]<class Real, class Space>() {
    return run_on<Real, Space>(typed, scene, plan, options, from);
  });
}

}  // namespace cayspin::program
