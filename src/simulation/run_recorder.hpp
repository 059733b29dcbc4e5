// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "checkpoint_schedule.hpp"
#include "io/run_output.hpp"
#include "scene_run.hpp"

#include <filesystem>

namespace cayspin::simulation {

/// Writes a run, from its present step to another, into a file and those beside it, as `cayspin
/// run` does:
///   RunRecorder recorder(run, end, "run.h5", false, commit);
///   for (recorder.look(); recorder.next() > run.steps(); recorder.look())
///     run.advance(recorder.next() - run.steps());
///   recorder.finish();
class RunRecorder {
 public:
  /// Throws std::runtime_error for a file that cannot be, or exists and `overwrite` is false.
  RunRecorder(SceneRun& run, std::int64_t end, std::filesystem::path const& path, bool overwrite,
              std::string const& git_commit);
  RunRecorder(RunRecorder const&) = delete;
  RunRecorder& operator=(RunRecorder const&) = delete;

  /// The step at which the file next wants a frame, a sample or a question about the time; the
  /// present one at the end.
  std::int64_t next() const;
  /// Writes what is due at the present step; with `last`, a frame in any case.
  void look(bool last = false);
  /// Closes the file: as one of a run that went as planned, or of another.
  void finish(bool as_planned = true);

 private:
  SceneRun& run_;
  std::int64_t first_, end_, written_ = -1, sampled_ = -1;  // steps; the last frame and sample
  std::int64_t evaluations_before_;
  double seconds_before_;
  Kokkos::Timer clock_;
  std::filesystem::path checkpoint_;
  CheckpointSchedule checkpoints_;
  io::RunOutput file_;
};

}  // namespace cayspin::simulation
