// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "run_ensemble.hpp"

#include "cayspin_git_commit.hpp"
#include "describe.hpp"
#include "ensemble_on_ranks.hpp"
#include "files/file_beside.hpp"
#include "info_file.hpp"
#include "io/ensemble_checkpoint.hpp"
#include "io/ensemble_file.hpp"
#include "kokkos_of_command.hpp"
#include "simulation/checkpoint_schedule.hpp"
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
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {
namespace {

/// Kokkos, and how a rank with replicas uses it.
struct BegunEnsemble {
  RunSettings settings;
  std::unique_ptr<KokkosOfCommand> kokkos;
};

/// Prepares a command. Returns nothing on a rank without replicas.
std::optional<BegunEnsemble> begin_ensemble(io::Scene const& scene, DeviceOptions const& options,
                                            Ranks& ranks) {
  // Ranks without replicas must survive an interrupt, too: a launcher ends all ranks if one dies.
  catch_signals();
  auto const replicas = scene.ensemble.replicas;
  if (!ranks.keep_first(replicas, "the ensemble has " + counted(replicas, "replica")))
    return std::nullopt;
  auto const space = ranks.together([&] { return chosen_space(options.space); });
  auto const threads = threads_for(options, space, ranks);
  auto kokkos = ranks.together(
      [&] { return std::make_unique<KokkosOfCommand>(space, threads, options.device); });
  if (ranks.is_first()) warn_of_notes(scene);
  ranks.together([&] {
    if (ranks.is_first())
      require_free_output(output_file(scene, options.output), options.overwrite);
  });
  return BegunEnsemble{{.precision = options.precision, .space = space, .threads = threads},
                       std::move(kokkos)};
}

/// `first`: the run of the first replica. Removes an old checkpoint, which would be taken for this
/// run's.
io::EnsembleFile open_file(io::Scene const& scene, DeviceOptions const& options,
                           SceneRun const& first) {
  auto header = run_header(first.scene(), options.precision, first.space(), first.threads(),
                           CAYSPIN_GIT_COMMIT);
  header.scene_text = scene.text;
  auto const path = output_file(scene, options.output);
  require_free_output(path, options.overwrite);
  io::EnsembleFile file(path, header, scene.ensemble,
                        run_output_options(first.scene(), options.overwrite));
  std::filesystem::remove(io::checkpoint_beside(path));
  return file;
}

/// Runs an ensemble. The first rank writes the frames and samples of all ranks into a file.
class RecordedEnsemble {
 public:
  RecordedEnsemble(io::Scene const& scene, RunOptions const& options, RunSettings const& settings,
                   Ranks& ranks)
      : scene_(scene),
        ranks_(ranks),
        run_(scene, settings, false, ranks),
        looks_(run_.own().looks(true, interrupt_requested)),
        progress_(io::sites(scene) * scene.ensemble.replicas,
                  ranks.is_first() ? options.listener : Listener::nobody),
        path_(output_file(scene, options.output)),
        precision_(options.precision) {
    if (options.restart) continue_from(*options.restart);
    checkpoints_.emplace(scene.output.checkpoint_every, first_);
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
    try {
      // If the earlier run was interrupted, its replicas may be at different steps.
      if (auto const furthest = run_.furthest(); furthest > first_) {
        looks_.at_end = furthest == end || furthest % scene_.output.every == 0 ||
                        furthest % scene_.output.scalars_every == 0;
        ending = run_.advance(furthest, looks_);
        first_ = run_.steps();
      }
      if (ending != Advanced::interrupted) look(false);
      while (ending == Advanced::whole && run_.steps() < end) {
        auto const& output = scene_.output;
        auto const next = std::min({end, after(output.every), after(output.scalars_every)});
        auto const stop = std::min(next, next_checkpoint());
        // Only frames and samples look for an equilibrium, so that checkpoints change no results.
        looks_.at_end = stop == next;
        ending = run_.advance(stop, looks_);
        if (ending == Advanced::interrupted) break;
        bool const last = ending == Advanced::at_rest || run_.steps() == end;
        look(last);
        if (!last) store_if_due();
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
    end_checkpoints(interrupted);
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
    ranks_.together([&] {
      as_restart([&] {
        for (auto const& read : {file, io::checkpoint_beside(file)})
          require_not_written(read, path_);
      });
    });
    auto const warning = as_restart([&] { return run_.continue_from(file); });
    if (warning) print_message("warning: --restart {}\n", *warning);
    first_ = run_.steps();
  }

  // Returns the next multiple of `every`.
  std::int64_t after(std::int64_t every) const { return (run_.steps() / every + 1) * every; }

  // Returns the step at which a checkpoint may be due next. With a period in seconds, the time to
  // that step is about a tenth of the period.
  std::int64_t next_checkpoint() {
    constexpr std::int64_t most = 4096;
    auto const& [seconds, steps] = scene_.output.checkpoint_every;
    if (steps > 0) return after(steps);
    if (seconds == 0) return run_.last_step();
    auto const taken = run_.steps() - first_;
    auto const fit = static_cast<double>(taken) * seconds / 10 / std::max(1e-9, clock_.seconds());
    return run_.steps() +
           ranks_.lowest(static_cast<std::int64_t>(std::clamp(fit, 1.0, double{most})));
  }
  void store_if_due() {
    bool const is_due = checkpoints_->due({run_.steps(), 0, 0, false});
    if (!ranks_.any({is_due, false})[0]) return;
    store();
    checkpoints_->wait();
  }
  void store() {
    auto header = checkpoint_header(run_.own().first().scene(), precision_, run_.steps(),
                                    ranks_.is_first() ? run_.time() : 0);
    header.scene_text = scene_.text;
    run_.store(io::checkpoint_beside(path_), header);
  }
  // Stores a checkpoint if a restart needs it in addition to the last frame.
  void end_checkpoints(bool interrupted) {
    if (scene_.output.checkpoint_every.is_never()) return;
    if (run_.remembers())
      store();
    else if (!interrupted)
      ranks_.together([&] {
        if (ranks_.is_first()) std::filesystem::remove(io::checkpoint_beside(path_));
      });
  }

  void look(bool last) {
    auto const step = run_.steps();
    if (step == frame_step_) return;  // all replicas of the restart file had ended
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
    if (!has_frame) return;
    ++frames_;
    frame_step_ = step;
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
  std::int64_t first_ = 0, frames_ = 0, frame_step_ = -1;
  simulation::Looks looks_;
  Progress progress_;
  std::filesystem::path path_;
  Precision precision_;
  std::optional<CheckpointSchedule> checkpoints_;
  std::optional<io::EnsembleFile> file_;  // on the first rank
  Kokkos::Timer clock_;
};

}  // namespace

int run_ensemble(io::Scene const& scene, RunOptions const& options, Ranks& ranks) {
  auto const begun = begin_ensemble(scene, options, ranks);
  if (!begun) return Status::done;
  return RecordedEnsemble(scene, options, begun->settings, ranks).run();
}

int relax_ensemble(io::Scene const& scene, DeviceOptions const& options,
                   RelaxEnsembleOptions const& search, Ranks& ranks) {
  require_alike(scene, options,
                fmt::format("{} {} {}", search.torque, search.evaluations, search.keep_saddles),
                ranks);
  auto const begun = begin_ensemble(scene, options, ranks);
  if (!begun) return Status::done;
  Kokkos::Timer const clock;
  EnsembleOnRanks run(scene, begun->settings, true, ranks);
  std::optional<io::EnsembleFile> file;
  ranks.together([&] {
    if (ranks.is_first()) file.emplace(open_file(scene, options, run.own().first()));
  });
  auto const minima = run.relax({.torque = search.torque,
                                 .evaluations = search.evaluations,
                                 .keep_saddles = search.keep_saddles,
                                 .interrupted = interrupt_requested});
  std::vector<io::RelaxedReplica> found;
  io::RunCost cost;
  for (auto const& minimum : minima) {
    if (minimum.end == MinimizeEnd::interrupted) continue;
    cost.evaluations += minimum.evaluations;
    found.push_back({minimum.torque, minimum.end == MinimizeEnd::converged, minimum.evaluations});
  }
  auto const searches = std::ssize(found);
  auto const failures = std::ranges::count(found, false, &io::RelaxedReplica::converged);
  cost.wall_seconds = cost.step_seconds = clock.seconds();
  auto const [is_interrupted, fails] = ranks.any({searches < std::ssize(minima), failures > 0});
  if (is_interrupted) {
    ranks.together([&] {
      if (!file) return;
      file->close(cost);
      print_message("{}: interrupted after {} of {} replicas; no frame was written\n",
                    scene.path.string(), searches, scene.ensemble.replicas);
    });
    return Status::interrupted;
  }
  auto const scalars = run.scalars();
  auto const spins = run.spins();
  ranks.together([&] {
    if (!file) return;
    file->write_scalars(0, 0, scalars);
    file->write_frame(0, 0, scalars, spins);
    file->write_relaxed(found);
    file->finish(cost);
    auto const path = output_file(scene, options.output);
    if (search.json)
      print_json(as_json(read_info_file(path)));
    else if (!search.quiet)
      fmt::print("{}: {} of {} converged after {} in {}\n", path.string(), searches - failures,
                 counted(searches, "replica"), counted(cost.evaluations, "evaluation"),
                 duration_text(cost.wall_seconds));
    if (failures > 0)
      print_message("{}: {} of {} did not converge\n", scene.path.string(), failures,
                    counted(searches, "replica"));
  });
  return fails ? Status::numbers_failed : Status::done;
}

}  // namespace cayspin::program
