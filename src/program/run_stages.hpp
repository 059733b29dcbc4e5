// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "cayspin_git_commit.hpp"
#include "command.hpp"
#include "end_of_search.hpp"
#include "io/checkpoint.hpp"
#include "io/relax.hpp"
#include "io/stages.hpp"
#include "progress.hpp"
#include "run_watch.hpp"
#include "run_writer.hpp"
#include "simulation/checkpoint_of_ranks.hpp"
#include "simulation/kokkos_settings.hpp"
#include "simulation/message.hpp"
#include "simulation/more_of_sample.hpp"
#include "simulation/plan.hpp"
#include "simulation/restart.hpp"
#include "simulation/scene_minimizer.hpp"
#include "simulation/text.hpp"

#include <cayspin/serialize.hpp>

#include <fmt/format.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {

struct RunOptions : DeviceOptions {
  std::optional<std::filesystem::path> restart;
  std::optional<std::string> ranks;  // Y,Z as typed
  Listener listener = Listener::user;
};

/// A stage with its plan. Stages before the one that a restart continues have no plan.
struct PlannedStage {
  io::Stage stage;
  std::optional<Plan> plan;
};

/// Returns true for a stage without steps: the start of a scene that has an integrator only in its
/// [[stage]] tables.
inline bool is_start(io::Stage const& stage) {
  return !stage.relax && !io::has_integrator(stage.scene);
}

/// Calls work(). Puts the option --restart before the message of a UsageError.
template <class Work>
auto as_restart(Work const& work) {
  try {
    return work();
  } catch (UsageError const& error) {
    throw UsageError(std::string("--restart ") + error.what());
  }
}

/// Runs one stage after another, starting with the first that has a plan, and writes all frames and
/// samples into one file.
template <class Real, class Space>
class RunOfStages {
  using Spins = SpinField<Real, typename Space::memory_space>;

 public:
  /// `typed`: the scene as typed, with all stages. `resolved`: the text of the scene with the
  /// method that was chosen for "auto"; empty if the method is not "auto". `plan_of`: returns a new
  /// plan for a stage that starts at another step than planned.
  RunOfStages(io::Scene const& typed, std::string resolved, std::vector<PlannedStage> stages,
              std::function<Plan(io::Stage const&)> plan_of, RunOptions const& options,
              Restart const* restart, Ranks& ranks)
      : typed_(typed),
        resolved_(std::move(resolved)),
        stages_(std::move(stages)),
        plan_of_(std::move(plan_of)),
        options_(options),
        restart_(restart),
        ranks_(ranks),
        path_(output_file(typed, options.output)),
        progress_(io::sites(typed), ranks.is_first() ? options.listener : Listener::nobody),
        writer_(
            typed, stages_.back().plan->lattice.sites(), [this] { return open_file(); }, ranks) {
    while (!stages_[now_].plan) ++now_;
    first_ = now_;
  }

  int run() {
    start_ = ranks_.together([&] { return start(); });
    if (restart_) shift_ = restart_->shift();
    for (;; ++now_) {
      step_ = scene().begin.step;
      if (restart_ && now_ == first_) step_ = restart_->step();
      if (stage().relax || is_start(stage()))
        rest();
      else
        advance();
      if (!goes_on()) break;
      enter_next();
    }
    return end();
  }

 private:
  io::Stage const& stage() const { return stages_[now_].stage; }
  io::Scene const& scene() const { return stage().scene; }
  Plan const& plan() const { return *stages_[now_].plan; }
  bool is_last() const { return now_ + 1 == stages_.size(); }
  bool goes_on() const { return !failure_ && !interrupted_ && !is_last(); }

  void begin_progress() {
    progress_.begin_stage(step_, io::end_of(stages_.back().stage), !scene().integrator.tolerance,
                          stages_.size() > 1 ? io::stage_text(stage()) : std::string());
  }

  std::vector<double> start() const {
    auto const own = own_sites(plan().lattice);
    // run() calls start() inside together(), which ends all ranks if one throws. Therefore the
    // expressions of lattice.occupied and lattice.frozen are tried here.
    io::occupied(scene(), own);
    io::frozen(scene(), own);
    if (!restart_) return io::initial_spins(scene(), own);
    return as_restart([&] { return restart_->spins(scene(), own); });
  }

  io::RunOutput open_file() const {
    auto header = run_header(typed_, options_.precision, chosen_space(options_.space),
                             threads_of(Space()), CAYSPIN_GIT_COMMIT);
    header.resolved_scene = resolved_;
    if (header.stage || scene().begin != io::StageBegin{}) header.stage = scene().begin;
    auto files = run_output_options(resolved_.empty() ? typed_ : scene(), options_.overwrite);
    files.most_planes = ranks_.planes_at_once(plan().lattice);
    return open_output(path_, header, files);
  }

  /// Runs a stage without steps: finds an equilibrium of the field, or keeps the start.
  void rest() {
    begin_progress();
    Space const exec;
    Spins spins("spins", plan().lattice);
    copy_from_host(start_, spins);
    if (stage().relax && !relax(exec, spins)) return;
    SceneGenerator<Spins> const generator(scene(), plan().lattice);
    Step const step{step_, scene().begin.time, 1, true};
    auto more = MoreOfSample<Spins>(scene(), plan().lattice)(exec, generator, step, spins);
    if (scene().lattice.follow) more.push_back(static_cast<double>(shift_));
    writer_.write(exec, scene(), sample_scene(exec, generator, step, spins), spins, shift_, true,
                  more);
    keep(spins);
    if (goes_on()) return;
    finish_file();
    if (stores_checkpoints()) remove_checkpoint();
  }

  bool stores_checkpoints() {
    bool const has_file = ranks_.any({writer_.file().has_value(), false})[0];
    return has_file && !scene().output.checkpoint_every.is_never();
  }
  void remove_checkpoint() const {
    if (ranks_.is_first()) std::filesystem::remove(io::checkpoint_beside(path_));
  }

  bool relax(Space const& exec, Spins& spins) {
    auto const& [torque, evaluations, keep_saddles] = *stage().relax;
    auto const& units = scene().units;
    Kokkos::Timer const clock;
    auto const found = SceneMinimizer<Real, Space>(spins).relax(
        exec, scene(), field_of<Spins>(scene(), plan().lattice, false).made_for(FieldFor::energy),
        spins,
        {.torque = torque / units.field,
         .evaluations = evaluations,
         .time = scene().begin.time,
         .keep_saddles = keep_saddles,
         .observer = [](Minimum const&) {
           return interrupt_requested() ? Next::stop : Next::proceed;
         }});
    total_.evaluations += found.evaluations;
    total_.step_seconds += clock.seconds();
    interrupted_ = found.end == MinimizeEnd::interrupted;
    auto const state =
        fmt::format("{}, max |m x H| = {:.3g}{}", end_text(found.end, found.evaluations),
                    found.torque * units.field, units.si ? " T" : "");
    if (found.end == MinimizeEnd::converged)
      progress_.tell(state);
    else if (!interrupted_)
      failure_ = fmt::format("{}: relax: {}", io::stage_text(stage()), state);
    return !interrupted_ && !failure_;
  }

  void advance() {
    auto times = plan().times;
    times.first = step_;
    RunningScene<Real, Space> simulation(scene(), plan(), times, start_);
    std::vector<double>().swap(start_);
    begin_progress();
    Watch<Real, Space> watch(scene(), simulation, writer_, progress_, ranks_);
    auto const store = [&](Step const& step) {
      bool continues = true;
      store_checkpoint(scene().begin, step.number, step.time * scene().units.time,
                       [&](Checkpoint& to) { simulation.exchange(to, continues); });
    };
    watch.store_checkpoints_by(store);
    simulation.go_on_from(shift_);
    if (restart_ && now_ == first_ && restart_->memory()) {
      CheckpointForRank part(plan().lattice, *restart_->memory());
      simulation.exchange(part, simulation.times.continues);
    }
    auto const [summary, failure] = simulation.advance(watch);
    shift_ = simulation.shift();
    add(summary);
    step_ = times.first + summary.steps;
    failure_ = failure ? failure : watch.failure();
    broke_ = failure.has_value();
    interrupted_ = watch.interrupted();
    if (watch.at_saddle()) saddles_.push_back(now_);
    keep(simulation.spins);
    if (goes_on()) return;
    finish_file();
    if (failure_) return;
    if (!stores_checkpoints()) return;
    // A method that does not remember earlier steps can continue from the last frame, and needs no
    // checkpoint.
    auto const step = writer_.last_frame()->step;
    if (remembers(scene(), plan()))
      store({step, plan().times.at(step), plan().times.dt, true});
    else
      remove_checkpoint();
  }

  // Sets where the next stage begins. If the current stage has ended early, also plans the later
  // stages again, and stores a checkpoint, because no frame tells where the next stage begins.
  void enter_next() {
    auto& next = stages_[now_ + 1];
    auto const planned = next.stage.scene.begin;
    next.stage.scene.begin = io::begin_after(scene(), step_, next.stage.scene);
    if (next.stage.scene.begin == planned) return;
    for (std::size_t n = now_ + 1; n < stages_.size(); ++n) {
      auto& [stage, plan] = stages_[n];
      if (n > now_ + 1) {
        auto const& before = stages_[n - 1].stage;
        stage.scene.begin = io::begin_after(before.scene, io::end_of(before), stage.scene);
      }
      plan.emplace(ranks_.together([&] { return plan_of_(stage); }));
    }
    if (scene().output.checkpoint_every.is_never()) return;
    writer_.wait();
    auto const& begin = next.stage.scene.begin;
    store_checkpoint(begin, step_, begin.time * next.stage.scene.units.time, [&](Checkpoint& to) {
      Spins const spins("spins", plan().lattice);
      copy_from_host(start_, spins);
      cayspin::detail::ExchangeMemory const visit(to);
      visit("spins", spins);
      if (scene().lattice.follow) visit("follow.shift", shift_);
    });
  }

  template <class Exchange>
  void store_checkpoint(io::StageBegin const& begin, std::int64_t step, double time,
                        Exchange const& exchange) {
    std::optional<io::CheckpointWriter> file;
    ranks_.together([&] {
      if (!ranks_.is_first()) return;
      auto header = checkpoint_header(typed_, options_.precision, step, time);
      header.resolved_scene = resolved_;
      header.stage = begin;
      file.emplace(io::checkpoint_beside(path_), header);
    });
    CheckpointFromRanks checkpoint(ranks_, plan().lattice, file ? &*file : nullptr);
    exchange(checkpoint);
    checkpoint.commit();
  }

  void keep(Spins const& spins) {
    if (is_last()) return;
    auto const numbers = copy_to_host(spins);
    start_.assign(numbers.begin(), numbers.end());
  }

  void add(Summary const& summary) {
    progress_.add(summary);
    total_.steps += summary.steps;
    total_.evaluations += summary.evaluations;
    total_.step_seconds += summary.step_seconds;
    total_.own_steps += summary.own_steps;
    total_.rejected += summary.rejected;
  }

  void finish_file() {
    if (is_closed_) return;
    is_closed_ = true;
    io::RunCost const cost{total_.evaluations, clock_.seconds(), total_.step_seconds};
    bool const whole = !failure_ && !interrupted_;
    frames_ = ranks_.together([&]() -> std::int64_t {
      auto& file = writer_.file();
      if (!file) return 0;
      auto const written = file->frames();
      whole ? file->finish(cost) : file->close(cost);
      return written;
    });
  }

  std::string kept() const {
    auto const& frame = writer_.last_frame();
    if (!frame) return "no frame was written";
    return fmt::format("the last good frame is {} in {} (step {}, t = {})", frames_ - 1,
                       path_.string(), frame->step, time_text(writer_.last_units(), frame->time));
  }

  int end() {
    finish_file();
    bool const speaks = ranks_.is_first();
    if (speaks && !broke_) progress_.close(total_, frames_, path_.string());
    if (failure_)
      ranks_.together([&] {
        if (speaks)
          throw NumbersFailed(fmt::format("{}: {}; {}", typed_.path.string(), *failure_, kept()));
      });
    for (auto const number : saddles_)
      if (speaks && options_.listener == Listener::user)
        fmt::print(
            "{}: {}ended at a saddle or a maximum of the energy: max |m x H| is below "
            "integrator.until_torque, but the energy has a direction down; accepted: another "
            "start, or cayspin relax\n",
            typed_.path.string(),
            stages_.size() > 1 ? io::stage_text(stages_[number].stage) + ": " : std::string());
    if (!interrupted_) return Status::done;
    if (speaks)
      print_message("{}: interrupted after step {} of {}; {}\n", typed_.path.string(), step_,
                    io::end_of(stages_.back().stage), kept());
    return Status::interrupted;
  }

  Kokkos::Timer const clock_;
  io::Scene const& typed_;
  std::string resolved_;
  std::vector<PlannedStage> stages_;
  std::function<Plan(io::Stage const&)> plan_of_;
  RunOptions const& options_;
  Restart const* restart_;
  Ranks& ranks_;
  std::filesystem::path path_;
  std::size_t now_ = 0, first_ = 0;  // indices of stages
  std::int64_t step_ = 0, frames_ = 0;
  std::int64_t shift_ = 0;     // cells by which the lattice has moved
  std::vector<double> start_;  // initial spins of the stage
  Progress progress_;
  RunWriter<Real, Space> writer_;
  Summary total_;
  std::optional<std::string> failure_;
  std::vector<std::size_t> saddles_;
  bool interrupted_ = false, broke_ = false, is_closed_ = false;
};

}  // namespace cayspin::program
