// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "checkpoint_schedule.hpp"
#include "io/run_output.hpp"
#include "scene_run.hpp"

#include <filesystem>

namespace cayspin::simulation {

/// Records a run, from its current step to step `end`, in a file and its companions, like `cayspin
/// run`:
///   RunRecorder recorder(run, end, "run.h5", false, commit);
///   for (recorder.look(); recorder.next() > run.steps(); recorder.look())
///     run.advance(recorder.next() - run.steps());
///   recorder.finish();
class RunRecorder {
 public:
  /// Throws std::runtime_error if the file cannot be created, or if it exists and `overwrite` is
  /// false.
  RunRecorder(SceneRun& run, std::int64_t end, std::filesystem::path const& path, bool overwrite,
              std::string const& git_commit);
  RunRecorder(RunRecorder const&) = delete;
  RunRecorder& operator=(RunRecorder const&) = delete;

  /// Returns the next step at which to call look(): for a frame, a sample or a checkpoint; at the
  /// end, the current step.
  std::int64_t next() const;
  /// Writes what is due at the current step, once; with `last`, always a frame. Throws
  /// NumbersFailed, and writes nothing, if the guard refuses the state.
  void look(bool last = false);
  /// Closes the file, and marks in it whether the run went as planned. If the scene has
  /// output.checkpoint_every, and the last frame is of the current step, also stores the checkpoint
  /// or, if a restart needs none, removes it.
  void finish(bool as_planned = true);

 private:
  SceneRun& run_;
  // Steps. written_ and sampled_ are those of the last frame and the last sample.
  std::int64_t first_, end_, written_ = -1, sampled_ = -1;
  std::int64_t evaluations_before_;
  double seconds_before_;
  Kokkos::Timer clock_;
  std::filesystem::path checkpoint_;
  CheckpointSchedule checkpoints_;
  io::RunOutput file_;
};

}  // namespace cayspin::simulation
