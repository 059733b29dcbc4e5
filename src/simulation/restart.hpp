// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/checkpoint.hpp"
#include "io/trajectory.hpp"
#include "plan.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation {

/// Does a run of this plan need more than its spins to go on with the same bits?
bool remembers(io::Scene const& scene, Plan const& plan);

/// What an earlier run left: a trajectory, the checkpoint beside it, or a checkpoint.
struct EarlierRun {
  explicit EarlierRun(std::filesystem::path path);

  /// The scene as it ran, with the method that was chosen where that is "auto".
  std::string const& scene_as_run() const;
  /// The scene as typed; resolved_scene is empty unless its method is "auto".
  std::string const& scene_text() const;
  std::string const& resolved_scene() const;

  std::filesystem::path path;
  std::optional<io::TrajectoryInfo> trajectory;
  std::unique_ptr<io::CheckpointReader> checkpoint;
};

/// The state from which a run of a scene goes on with the bits of a run without a break.
class Restart {
 public:
  /// Throws UsageError when there is no such state: the lattice, the precision or the units are
  /// others, its time is not that of a step, no step is left before `end`, or the method
  /// remembers steps that are in no checkpoint.
  Restart(EarlierRun from, io::Scene const& scene, Plan const& plan, Precision precision,
          std::int64_t end);

  std::int64_t step() const { return step_; }
  /// Those of a box, or all, as io::read_spins gives them: bits are kept. Throws UsageError where
  /// other sites are vacant than in the scene.
  std::vector<double> spins(io::Scene const& scene, io::SiteBox const& box) const;
  std::vector<double> spins(io::Scene const& scene) const;
  /// What the run remembered, where that is needed.
  io::CheckpointReader* memory() const { return memory_; }
  /// One line that names what differs from the scene of the file, beside what may.
  std::optional<std::string> const& warning() const { return warning_; }
  /// The files that it reads.
  std::vector<std::filesystem::path> files() const;

 private:
  EarlierRun from_;
  std::int64_t step_ = 0;
  bool uses_checkpoint_ = false;
  io::CheckpointReader* memory_ = nullptr;
  std::optional<std::string> warning_;
};

}  // namespace cayspin::simulation
