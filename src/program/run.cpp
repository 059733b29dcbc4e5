// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "cayspin_git_commit.hpp"
#include "command.hpp"
#include "restart.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/text.hpp"
#include "trade/resolved.hpp"
#include "watch.hpp"

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
  auto const reason = dt_warning(plan);
  if (!reason) return;
  auto const error = io::scene_error(scene, "integrator.dt", *reason);
  if (scene.integrator.refuse_unstable) throw error;
  fmt::print(stderr, "warning: {}\n", error.what());
}

template <class Space>
io::TrajectoryHeader make_header(io::Scene const& typed, io::Scene const& scene,
                                 Precision precision, Space const& exec) {
  io::TrajectoryHeader header;
  header.scene_text = typed.text;
  if (typed.integrator.method->automatic) header.resolved_scene = scene.text;
  header.cayspin_version = CAYSPIN_VERSION_STRING;
  header.git_commit = CAYSPIN_GIT_COMMIT;
  header.kokkos_version = fmt::format("{}.{}.{}", KOKKOS_VERSION / 10000,
                                      KOKKOS_VERSION / 100 % 100, KOKKOS_VERSION % 100);
  header.space = space_name<Space>();
  header.precision = to_string(precision);
  header.threads = cayspin::detail::is_host_execution<Space> ? exec.concurrency() : 1;
  header.shape = scene.lattice.shape;
  return header;
}

io::RunOutputOptions output_options(io::Scene const& scene, RunOptions const& options) {
  auto const& output = scene.output;
  return {.overwrite = options.overwrite,
          .storage = {output.compression, output.chunk},
          .xdmf = output.xdmf,
          .table = output.table,
          .spacing = scene.lattice.spacing};
}

template <class Real, class Space>
int run_on(io::Scene const& typed, io::Scene const& scene, Plan const& plan,
           RunOptions const& options, Restart const* restart) {
  Kokkos::Timer const clock;
  auto times = plan.times;
  if (restart) times.first = restart->step();
  Simulation<Real, Space> simulation(scene, plan.lattice, times,
                                     restart ? restart->spins() : io::initial_spins(scene));

  auto const path = output_file(scene, options);
  Watch<Real, Space> watch(
      scene, simulation.generator, simulation.spins, times.first,
      [&] {
        return io::RunOutput(path, make_header(typed, scene, options.precision, simulation.exec),
                             output_options(scene, options));
      },
      options.quiet);
  std::optional<ControlledWatch<Real, Space>> controlled;
  if (scene.integrator.energy_control)
    controlled.emplace(watch, simulation.generator, simulation.spins);

  auto const kept = [&] {
    if (!watch.file()) return std::string("no frame was written");
    auto const& frame = watch.last_frame();
    return fmt::format("the last good frame is {} in {} (step {}, t = {:.9g})",
                       watch.file()->frames() - 1, path.string(), frame.step, frame.time);
  };
  auto const failed = [&](std::string const& why) {
    return NumbersFailed(fmt::format("{}: {}; {}", scene.path.string(), why, kept()));
  };
  auto [summary, failure] = controlled ? simulation.advance(plan.variant, plan.options, *controlled)
                                       : simulation.advance(plan.variant, plan.options, watch);
  if (failure) throw failed(*failure);
  if (controlled) summary.evaluations += controlled->evaluations();
  auto const frames = watch.file() ? watch.file()->frames() : 0;
  io::RunCost const cost{summary.evaluations, clock.seconds(), summary.step_seconds};
  bool const whole = !watch.failure() && !watch.interrupted();
  if (watch.file()) whole ? watch.file()->finish(cost) : watch.file()->close(cost);
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
  if (typed.integrator.energy_control && options.restart)
    throw UsageError(
        "--restart: energy_control holds the energy that a run begins with; accepted: "
        "a run from its begin, or no energy_control");
  if (typed.integrator.compensated && options.restart)
    throw UsageError(
        "--restart: compensated goes on with what rounding left over, which is in no file; "
        "accepted: a run without it");
  if (typed.integrator.method->automatic && options.restart)
    throw UsageError(
        "--restart: method \"auto\" may choose other steps; accepted: the method and "
        "dt or tolerance that `cayspin advise` names");
  auto const scene = trade::with_method(typed, space, options.precision);
  if (typed.integrator.method->automatic && !options.quiet)
    fmt::print("method auto: {}, {}\n", describe_method(scene.integrator),
               scene.integrator.tolerance
                   ? fmt::format("tolerance {:.3g}", *scene.integrator.tolerance)
                   : fmt::format("dt {:.9g}", scene.integrator.dt));
  auto const plan = make_plan(scene, options.precision);
  require_memory(scene, plan);
  std::optional<Restart> restart;
  if (options.restart) restart.emplace(*options.restart, scene, options.precision);
  std::error_code ignored;
  if (restart && std::filesystem::equivalent(restart->path(), output_file(scene, options), ignored))
    throw UsageError(
        fmt::format("--restart {}: the run would write into it; accepted: another file"
                    " for --output",
                    restart->path().string()));
  Restart const* const from = restart ? &*restart : nullptr;
  warn_above_stable_dt(scene, plan);
  catch_signals();
  return in_space(space, options.precision, [&]<class Real, class Space>() {
    return run_on<Real, Space>(typed, scene, plan, options, from);
  });
}

}  // namespace cayspin::program
