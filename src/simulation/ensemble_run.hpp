// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "guard.hpp"
#include "io/ensemble_file.hpp"
#include "replica_columns.hpp"
#include "scene_run.hpp"

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::simulation {

/// The replicas of a scene with [ensemble], which go on together from one step to another: as
/// columns of a few lattices if they can, otherwise each as a run of its own, small ones side by
/// side on the threads of the host. Replica r has the bits of a run of io::replica_of(scene, r).
/// Calls from several threads take turns, as those of SceneRun do; steps and time do not wait.
class EnsembleRun {
 public:
  /// For cayspin run, or where `relaxes` for cayspin relax; without settings.restart. Throws what
  /// SceneRun::open throws, also for too little memory.
  EnsembleRun(io::Scene const& scene, RunSettings const& settings, bool relaxes);
  EnsembleRun(EnsembleRun const&) = delete;
  EnsembleRun& operator=(EnsembleRun const&) = delete;

  std::size_t replicas() const { return at_rest_.size(); }
  /// Returns the run of the first replica, whose spins may be those of another.
  SceneRun const& first() const { return *runs_.front(); }
  /// Continues from the last frame of an ensemble's file. Returns one line that names unexpected
  /// differences from the scene of the file. Throws UsageError for a file that does not fit, and
  /// for a method that remembers more than the spins.
  std::optional<std::string> continue_from(std::filesystem::path const& file);

  /// Returns the warning of the first replica that has one about its steps, with its number; of
  /// replicas as columns that of the hottest.
  std::optional<std::string> warning() const;

  /// Steps that all replicas have taken that have not ended early.
  std::int64_t steps() const { return steps_; }
  std::int64_t last_step() const { return first().last_step(); }
  double time() const { return first().time_at(steps_); }  // after them
  std::int64_t evaluations() const;
  double step_seconds() const;
  /// Has each replica ended early, without torque?
  bool is_at_rest() const;

  /// Returns when advance checks the replicas: at its last step, and rarely before, because a check
  /// of a small lattice takes as long as a step. With the scene's until_torque as often as a run
  /// of its own, so that a replica ends where that would.
  Looks looks(bool until_torque, std::function<bool()> interrupted) const;

  /// Advances all replicas to step steps() + count. With looks.until_torque those that have ended
  /// early stay where they are. If one fails or is interrupted, some of the others are further than
  /// steps(), and wait for it when the run goes on.
  Advanced advance(std::int64_t count, Looks const& looks);

  /// Moves each replica to its own equilibrium, those that are small side by side. If one is
  /// interrupted, some of the others have not moved. Throws what SceneRun::relax throws.
  std::vector<Minimum> relax(RelaxSettings const& settings);

  std::vector<io::Scalars> scalars();
  /// Packed as (replica, nz, ny, nx, 3), in the precision of the run.
  std::vector<std::byte> spins();

 private:
  Advanced advance_runs(std::int64_t target, Looks const& looks);
  Advanced advance_columns(std::int64_t target, Looks const& looks);
  /// Returns the steps that all runs have taken that have not ended early.
  std::int64_t steps_of_all() const;
  void check_columns();
  /// Gives each replica a run of its own, from where it is.
  void leave_columns();

  io::Scene scene_;
  RunSettings settings_;
  std::vector<std::unique_ptr<SceneRun>> runs_;  // only the first one beside columns
  std::optional<ReplicaColumns> columns_;
  std::vector<Guard> guards_;    // of columns
  std::vector<Sample> samples_;  // of columns after these steps, or empty
  std::vector<bool> at_rest_;
  std::atomic<std::int64_t> steps_ = 0;
};

}  // namespace cayspin::simulation
