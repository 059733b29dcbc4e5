// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "progress.hpp"
#include "run_writer.hpp"
#include "simulation/checkpoint_schedule.hpp"
#include "simulation/ranks.hpp"
#include "simulation/running_scene.hpp"

#include <cayspin/observer/record.hpp>

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {

using namespace simulation;

/// Observer of a stage of `cayspin run`: writes frames, scalars and checkpoints, shows progress,
/// and ends the stage early at rest, on an interrupt or on a failure. It is due at the same steps
/// on all ranks.
template <class Real, class Space>
class Watch : public RunObserver<Space, SpinField<Real, typename Space::memory_space>> {
  using Spins = SpinField<Real, typename Space::memory_space>;

 public:
  using StoreCheckpoint = std::function<void(Step const&)>;

  Watch(io::Scene const& scene, RunningScene<Real, Space>& run, RunWriter<Real, Space>& writer,
        Progress& progress, Ranks& ranks)
      : ranks_(ranks),
        run_(run),
        writer_(writer),
        progress_(progress),
        scene_(scene),
        first_(run.times.first),
        checkpoints_(scene.output.checkpoint_every, first_) {
    // If there is a frame, the previous stage has already written this state.
    is_written_ = writer.last_frame().has_value();
  }

  /// Sets the function that stores a checkpoint; call before the run starts.
  void store_checkpoints_by(StoreCheckpoint store) { store_checkpoint_ = std::move(store); }

  bool due(Step const& step) const override {
    return due_on_all(step) || (!ranks_.many() && (progress_.due(step) || checkpoints_.due(step) ||
                                                   interrupt_requested()));
  }

  Next operator()(Space const& exec, Step const& step, Spins const& spins) override {
    if (progress_.due(step)) progress_.show(step);
    auto const [interrupt, stored] = ranks_.any({interrupt_requested(), checkpoints_.due(step)});
    bool const recorded = frame_due(step) || scalars_due(step) || interrupt;
    if (!recorded && !stored && step.number != first_ && !run_.guard().due(step))
      return Next::proceed;

    auto const found = run_.look(exec, step, spins, true, step.last);
    failure_ = found.failure;
    if (failure_) return Next::stop;
    bool const at_rest = found.at_rest && step.number > first_;
    at_saddle_ = found.at_saddle && step.last;
    bool const ends = interrupt || at_rest;
    interrupted_ = interrupt && !at_rest && !step.last;
    if (recorded || ends) {
      std::optional<std::vector<double>> more;
      if (scalars_due(step) || ends) more = run_.more(exec, step, spins);
      writer_.write(exec, scene_, found.sample, spins, run_.shift(), frame_due(step) || ends, more);
    }
    if (ends) return Next::stop;
    if (stored) {
      writer_.wait();
      store_checkpoint_(step);
      checkpoints_.wait();
    }
    return Next::proceed;
  }

  /// Returns why the run failed, if it did.
  std::optional<std::string> const& failure() const { return failure_; }
  bool interrupted() const { return interrupted_; }
  /// Returns true if the run ended with the torque below until_torque, but at a saddle or a maximum
  /// of the energy.
  bool at_saddle() const { return at_saddle_; }

 private:
  bool at(Step const& step, std::int64_t every) const {
    if (step.number == first_) return !is_written_;
    return step.last || (step.number - scene_.begin.step) % every == 0;
  }
  bool frame_due(Step const& step) const { return at(step, scene_.output.every); }
  bool scalars_due(Step const& step) const { return at(step, scene_.output.scalars_every); }
  bool due_on_all(Step const& step) const {
    return run_.guard().due(step) || step.number == first_ || frame_due(step) ||
           scalars_due(step) || (checkpoints_.is_by_steps() && checkpoints_.due(step));
  }

  Ranks& ranks_;
  RunningScene<Real, Space>& run_;
  RunWriter<Real, Space>& writer_;
  Progress& progress_;
  io::Scene const& scene_;
  std::int64_t first_;  // the step from which the run starts
  StoreCheckpoint store_checkpoint_;
  CheckpointSchedule checkpoints_;
  bool is_written_ = false;
  std::optional<std::string> failure_;
  bool interrupted_ = false, at_saddle_ = false;
};

}  // namespace cayspin::program
