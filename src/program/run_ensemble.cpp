// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "run_ensemble.hpp"

#include "cayspin_git_commit.hpp"
#include "describe.hpp"
#include "files/file_beside.hpp"
#include "info_file.hpp"
#include "io/ensemble_file.hpp"
#include "kokkos_of_command.hpp"
#include "simulation/ensemble_run.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/run_files.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program {
namespace {

RunSettings settings_of(DeviceOptions const& options, std::string const& space) {
  return {.precision = options.precision, .space = space, .threads = options.threads};
}

io::EnsembleFile open_file(io::Scene const& scene, DeviceOptions const& options, EnsembleRun& run) {
  auto header = run_header(run.first().scene(), options.precision, run.first().space(),
                           run.first().threads(), CAYSPIN_GIT_COMMIT);
  header.scene_text = scene.text;
  return {output_file(scene, options.output), header, scene.ensemble,
          run_output_options(run.first().scene(), options.overwrite)};
}

std::string kept(io::EnsembleFile const& file, std::filesystem::path const& path) {
  return file.frames() == 0
             ? std::string("no frame was written")
             : fmt::format("the last good frame is {} in {}", file.frames() - 1, path.string());
}

/// Runs an ensemble, and writes its frames and samples into a file.
class RecordedEnsemble {
 public:
  RecordedEnsemble(io::Scene const& scene, RunOptions const& options, std::string const& space)
      : scene_(scene),
        run_(scene, settings_of(options, space), false),
        looks_(run_.looks(true, interrupt_requested)),
        progress_(io::sites(scene) * scene.ensemble.replicas, options.listener),
        path_(output_file(scene, options.output)) {
    if (options.restart) continue_from(*options.restart);
    // warning() throws if the scene sets refuse_unstable and the dt of any replica is too large.
    if (auto const warning = run_.warning()) fmt::print(stderr, "warning: {}\n", *warning);
    file_.emplace(open_file(scene, options, run_));
  }

  int run() {
    auto const end = run_.last_step();
    auto const equal_steps = scene_.integrator.method->has_equal_steps();
    progress_.begin_stage(first_, end, equal_steps, {});
    auto ending = Advanced::whole;
    look(false);
    try {
      while (ending == Advanced::whole && run_.steps() < end) {
        auto const after = [&](std::int64_t every) { return (run_.steps() / every + 1) * every; };
        auto const next =
            std::min({end, after(scene_.output.every), after(scene_.output.scalars_every)});
        ending = run_.advance(next - run_.steps(), looks_);
        // advance() calls interrupt_requested only now and then, and may reach the next frame
        // without doing so.
        if (interrupt_requested() && run_.steps() < end) ending = Advanced::interrupted;
        if (ending == Advanced::interrupted) break;
        look(ending == Advanced::at_rest || run_.steps() == end);
      }
    } catch (NumbersFailed const& error) {
      file_->close(cost());
      throw NumbersFailed(fmt::format("{}; {}", error.what(), kept(*file_, path_)));
    }
    bool const interrupted = ending == Advanced::interrupted;
    interrupted ? file_->close(cost()) : file_->finish(cost());
    Summary total;
    total.steps = run_.steps() - first_;
    total.step_seconds = run_.step_seconds();
    progress_.close(total, file_->frames(), path_.string());
    if (!interrupted) return Status::done;
    fmt::print(stderr, "{}: interrupted after step {} of {}; {}\n", scene_.path.string(),
               run_.steps(), end, kept(*file_, path_));
    return Status::interrupted;
  }

 private:
  void continue_from(std::filesystem::path const& file) {
    auto const warning = as_restart([&] {
      require_not_written(file, path_);
      return run_.continue_from(file);
    });
    if (warning) fmt::print(stderr, "warning: --restart {}\n", *warning);
    first_ = run_.steps();
  }

  void look(bool last) {
    auto const step = run_.steps();
    auto const due = [&](std::int64_t every) {
      return last || step == first_ || step % every == 0;
    };
    Step const now{step, 0, 0, last};
    if (progress_.due(now)) progress_.show(now);
    if (!due(scene_.output.every) && !due(scene_.output.scalars_every)) return;
    auto const scalars = run_.scalars();
    if (due(scene_.output.scalars_every)) file_->write_scalars(step, run_.time(), scalars);
    if (due(scene_.output.every)) file_->write_frame(step, run_.time(), scalars, run_.spins());
  }

  io::RunCost cost() const { return {run_.evaluations(), clock_.seconds(), run_.step_seconds()}; }

  io::Scene const& scene_;
  EnsembleRun run_;
  std::int64_t first_ = 0;
  simulation::Looks looks_;
  Progress progress_;
  std::filesystem::path path_;
  std::optional<io::EnsembleFile> file_;
  Kokkos::Timer clock_;
};

}  // namespace

int run_ensemble(io::Scene const& scene, RunOptions const& options) {
  auto const space = chosen_space(options.space);
  KokkosOfCommand const kokkos(space, options.threads, options.device);
  warn_of_notes(scene);
  io::require_free(output_file(scene, options.output), options.overwrite);
  catch_signals();
  return RecordedEnsemble(scene, options, space).run();
}

int relax_ensemble(io::Scene const& scene, DeviceOptions const& options,
                   RelaxEnsembleOptions const& search) {
  auto const space = chosen_space(options.space);
  KokkosOfCommand const kokkos(space, options.threads, options.device);
  warn_of_notes(scene);
  io::require_free(output_file(scene, options.output), options.overwrite);
  catch_signals();
  Kokkos::Timer const clock;
  EnsembleRun run(scene, settings_of(options, space), true);
  auto file = open_file(scene, options, run);
  std::vector<io::RelaxedReplica> found;
  io::RunCost cost;
  auto const minima = run.relax({.torque = search.torque,
                                 .evaluations = search.evaluations,
                                 .keep_saddles = search.keep_saddles,
                                 .interrupted = interrupt_requested});
  for (auto const& minimum : minima) {
    if (minimum.end == MinimizeEnd::interrupted) continue;
    cost.evaluations += minimum.evaluations;
    found.push_back({minimum.torque, minimum.end == MinimizeEnd::converged, minimum.evaluations});
  }
  cost.wall_seconds = cost.step_seconds = clock.seconds();
  if (found.size() < run.replicas()) {
    file.close(cost);
    fmt::print(stderr, "{}: interrupted after {} of {} replicas; no frame was written\n",
               scene.path.string(), found.size(), run.replicas());
    return Status::interrupted;
  }
  auto const scalars = run.scalars();
  file.write_scalars(0, 0, scalars);
  file.write_frame(0, 0, scalars, run.spins());
  file.write_relaxed(found);
  file.finish(cost);
  auto const failures = std::ranges::count(found, false, &io::RelaxedReplica::converged);
  if (search.json)
    print_json(as_json(read_info_file(output_file(scene, options.output))));
  else if (!search.quiet)
    fmt::print("{}: {} of {} converged after {} in {}\n",
               output_file(scene, options.output).string(), std::ssize(found) - failures,
               counted(std::ssize(found), "replica"), counted(cost.evaluations, "evaluation"),
               duration_text(cost.wall_seconds));
  if (failures == 0) return Status::done;
  fmt::print(stderr, "{}: {} of {} did not converge\n", scene.path.string(), failures,
             counted(std::ssize(found), "replica"));
  return Status::numbers_failed;
}

}  // namespace cayspin::program
