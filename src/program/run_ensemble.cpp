// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "run_ensemble.hpp"

#include "cayspin_git_commit.hpp"
#include "describe.hpp"
#include "ensemble_on_ranks.hpp"
#include "files/file_beside.hpp"
#include "info_file.hpp"
#include "io/ensemble_file.hpp"
#include "kokkos_of_command.hpp"
#include "simulation/ensemble_run.hpp"
#include "simulation/failure.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/message.hpp"
#include "simulation/run_files.hpp"
#include "simulation/text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program {
namespace {

RunSettings settings_of(DeviceOptions const& options, std::string const& space) {
  return {.precision = options.precision, .space = space, .threads = options.threads};
}

/// `first`: the run of the first replica.
io::EnsembleFile open_file(io::Scene const& scene, DeviceOptions const& options,
                           SceneRun const& first) {
  auto header = run_header(first.scene(), options.precision, first.space(), first.threads(),
                           CAYSPIN_GIT_COMMIT);
  header.scene_text = scene.text;
  return {output_file(scene, options.output), header, scene.ensemble,
          run_output_options(first.scene(), options.overwrite)};
}

/// Runs an ensemble. The first rank writes the frames and samples of all ranks into a file.
class RecordedEnsemble {
 public:
  RecordedEnsemble(io::Scene const& scene, RunOptions const& options, std::string const& space,
                   Ranks& ranks)
      : scene_(scene),
        ranks_(ranks),
        run_(scene, settings_of(options, space), ranks),
        looks_(run_.own().looks(true, interrupt_requested)),
        progress_(io::sites(scene) * scene.ensemble.replicas,
                  ranks.is_first() ? options.listener : Listener::nobody),
        path_(output_file(scene, options.output)) {
    if (options.restart) continue_from(*options.restart);
    // warning() throws if the scene sets refuse_unstable and the dt of any replica is too large.
    if (auto const warning = run_.warning()) print_message("warning: {}\n", *warning);
    ranks_.together([&] {
      if (ranks_.is_first()) file_.emplace(open_file(scene, options, run_.own().first()));
    });
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
        ending = run_.advance(next, looks_);
        if (ending == Advanced::interrupted) break;
        look(ending == Advanced::at_rest || run_.steps() == end);
      }
    } catch (NumbersFailed const& error) {
      end_file(false);
      throw NumbersFailed(fmt::format("{}; {}", error.what(), kept()));
    } catch (OtherRankFailed const& other) {
      if (other.status == Status::numbers_failed) end_file(false);
      throw;
    }
    bool const interrupted = ending == Advanced::interrupted;
    auto const cost = end_file(!interrupted);
    Summary total;
    total.steps = run_.steps() - first_;
    total.step_seconds = cost.step_seconds;
    progress_.close(total, frames_, path_.string());
    if (!interrupted) return Status::done;
    if (ranks_.is_first())
      print_message("{}: interrupted after step {} of {}; {}\n", scene_.path.string(), run_.steps(),
                    end, kept());
    return Status::interrupted;
  }

 private:
  void continue_from(std::filesystem::path const& file) {
    ranks_.together([&] { as_restart([&] { require_not_written(file, path_); }); });
    auto const warning = as_restart([&] { return run_.continue_from(file); });
    if (warning) print_message("warning: --restart {}\n", *warning);
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
    bool const has_frame = due(scene_.output.every);
    auto const scalars = run_.scalars();
    auto const spins = has_frame ? run_.spins() : std::vector<std::byte>();
    ranks_.together([&] {
      if (!file_) return;
      if (due(scene_.output.scalars_every)) file_->write_scalars(step, run_.time(), scalars);
      if (has_frame) file_->write_frame(step, run_.time(), scalars, spins);
    });
    if (has_frame) ++frames_;
  }

  io::RunCost end_file(bool whole) {
    auto const cost = run_.cost(clock_.seconds());
    ranks_.together([&] {
      if (file_) whole ? file_->finish(cost) : file_->close(cost);
    });
    return cost;
  }

  std::string kept() const {
    return frames_ == 0
               ? std::string("no frame was written")
               : fmt::format("the last good frame is {} in {}", frames_ - 1, path_.string());
  }

  io::Scene const& scene_;
  Ranks& ranks_;
  EnsembleOnRanks run_;
  std::int64_t first_ = 0, frames_ = 0;
  simulation::Looks looks_;
  Progress progress_;
  std::filesystem::path path_;
  std::optional<io::EnsembleFile> file_;  // on the first rank
  Kokkos::Timer clock_;
};

}  // namespace

int run_ensemble(io::Scene const& scene, RunOptions const& options, Ranks& ranks) {
  auto const space = ranks.together([&] { return chosen_space(options.space); });
  auto const kokkos = ranks.together(
      [&] { return std::make_unique<KokkosOfCommand>(space, options.threads, options.device); });
  if (ranks.is_first()) warn_of_notes(scene);
  ranks.together([&] {
    if (ranks.is_first()) io::require_free(output_file(scene, options.output), options.overwrite);
  });
  return RecordedEnsemble(scene, options, space, ranks).run();
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
  auto file = open_file(scene, options, run.first());
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
    print_message("{}: interrupted after {} of {} replicas; no frame was written\n",
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
  print_message("{}: {} of {} did not converge\n", scene.path.string(), failures,
                counted(std::ssize(found), "replica"));
  return Status::numbers_failed;
}

}  // namespace cayspin::program
