// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/checkpoint.hpp"
#include "io/ensemble_file.hpp"
#include "io/stages.hpp"
#include "io/trajectory.hpp"
#include "plan.hpp"

#include <filesystem>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace cayspin::simulation {

/// Returns true if a run of this plan needs more than its spins to continue exactly, that is, with
/// bitwise identical results.
bool remembers(io::Scene const& scene, Plan const& plan);

/// The last frame of a run: the start of its stage, and its step, which is -1 if there is no frame.
struct LastFrame {
  io::StageBegin begin;
  std::int64_t step = -1;
};

/// Returns the last frame of a file. Each stage starts after the last frame of the previous one,
/// except the stage in which the file starts. Throws UsageError if the frames belong to other
/// stages than `stages`.
LastFrame last_frame(io::TrajectoryInfo const& trajectory, std::vector<io::Stage> stages);

/// Files of an earlier run: a trajectory and, if there is one, the checkpoint next to it; or only a
/// checkpoint.
struct EarlierRun {
  /// Throws UsageError for the file of an ensemble, and if the checkpoint is of another scene.
  explicit EarlierRun(std::filesystem::path path);
  /// The file of an ensemble with its last frame, the checkpoint, or both. Null: not there. Throws
  /// UsageError if they are of different scenes.
  EarlierRun(std::filesystem::path path, io::EnsembleInfo const* info,
             io::CheckpointHeader const* of_checkpoint);

  /// Returns the header of the checkpoint; null if there is none.
  io::CheckpointHeader const* checkpoint_header() const;

  /// Returns the scene as it ran, with the chosen method if its own method is "auto".
  std::string const& scene_as_run() const;
  /// Return the scene as typed, and the scene with the chosen method. The latter is empty unless
  /// the scene's own method is "auto".
  std::string const& scene_text() const;
  std::string const& resolved_scene() const;

  /// Returns where a scene continues: in the current stage of the run or, if that has ended, in the
  /// next one. Discards frames or a checkpoint of other stages. Throws UsageError if the scene has
  /// no such stage.
  io::StageBegin enter(std::vector<io::Stage> stages);

  std::filesystem::path path;
  std::optional<io::TrajectoryInfo> trajectory;
  std::unique_ptr<io::CheckpointReader> checkpoint;
  bool at_begin = false;  // continues at the start of a stage, where the method has no memory
  std::optional<io::CheckpointHeader> of_ensemble;  // of the checkpoint of an ensemble
  bool is_ensemble = false;
};

/// Throws UsageError if the vacant sites of `spins`, which are from the file `path` and of a box of
/// the lattice, differ from those of the scene. `occupied`: io::occupied() in that box.
void require_same_vacancies(std::filesystem::path const& path, io::SiteBox const& box,
                            std::vector<unsigned char> const& occupied,
                            std::span<double const> spins);

/// The state from which a run of a scene, or of a stage, continues. If the scene has not changed,
/// the results are bitwise identical to those of an uninterrupted run.
class Restart {
 public:
  /// Throws UsageError when there is no such state: the files hold no frame, the lattice, the
  /// precision or the units differ, the last time is not that of a step, no step is left before
  /// `end`, or no checkpoint has the steps that the method remembers.
  Restart(EarlierRun from, io::Scene const& scene, Plan const& plan, Precision precision,
          std::int64_t end);

  std::int64_t step() const { return step_; }
  /// Returns the spins of a box, or of the whole lattice, bit for bit, in the order of
  /// io::read_spins. Throws UsageError if the vacant sites differ from those of the scene. Not for
  /// ensembles.
  std::vector<double> spins(io::Scene const& scene, io::SiteBox const& box) const;
  std::vector<double> spins(io::Scene const& scene) const;
  /// Returns the checkpoint with the run's memory of earlier steps; null if it is not needed, and
  /// for ensembles.
  io::CheckpointReader* memory() const { return memory_; }
  /// Return true if the spins, or also the memory of earlier steps, are those of the checkpoint.
  bool uses_checkpoint() const { return uses_checkpoint_; }
  bool restores_memory() const { return restores_memory_; }
  /// Returns true if the file's scene has another value of the key.
  bool differs_in(std::string const& key) const;
  /// Returns by how many cells the lattice had moved to follow its object.
  std::int64_t shift() const { return shift_; }
  /// Returns one line that names unexpected differences from the scene of the file, or nothing.
  std::optional<std::string> const& warning() const { return warning_; }
  /// Returns the files from which the run continues.
  std::vector<std::filesystem::path> files() const;

 private:
  EarlierRun from_;
  std::int64_t step_ = 0, shift_ = 0;
  bool uses_checkpoint_ = false, restores_memory_ = false;
  std::vector<std::string> changes_;  // keys
  io::CheckpointReader* memory_ = nullptr;
  std::optional<std::string> warning_;
};

}  // namespace cayspin::simulation
