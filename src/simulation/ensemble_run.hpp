// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "guard.hpp"
#include "io/ensemble_checkpoint.hpp"
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

/// The replicas of a scene with [ensemble], or a share of them, which advance together. If possible
/// they are the columns of a few lattices (ReplicaColumns); otherwise each is a separate run, and
/// small ones run side by side on the threads of the host. The results of replica r are bitwise
/// identical to those of a run of io::replica_of(scene, r). Calls from several threads take turns,
/// as with SceneRun; steps(), time() and replicas() do not wait for a turn.
class EnsembleRun {
 public:
  /// Opens the replicas for `cayspin run` or, if `relaxes` is true, for `cayspin relax`.
  /// settings.restart must be empty. Throws what SceneRun::open throws, also if there is too little
  /// memory for all replicas.
  EnsembleRun(io::Scene const& scene, RunSettings const& settings, bool relaxes)
      : EnsembleRun(scene, settings, relaxes, all_replicas(scene)) {}
  /// Opens a share of the replicas. Members count these from 0; messages have their numbers in the
  /// whole ensemble.
  EnsembleRun(io::Scene const& scene, RunSettings const& settings, bool relaxes,
              ReplicaShare const& share);
  EnsembleRun(EnsembleRun const&) = delete;
  EnsembleRun& operator=(EnsembleRun const&) = delete;

  std::size_t replicas() const { return static_cast<std::size_t>(share_.own.count); }
  /// Returns the number of the first replica in the whole ensemble.
  std::int64_t first_number() const { return share_.own.first; }
  /// Returns the run of the first replica. If the replicas are columns, this run's spins do not
  /// advance with them.
  SceneRun const& first() const { return *runs_.front(); }
  /// Continues from the last frame of the whole ensemble's file, from the checkpoint beside it, or
  /// from a checkpoint without it. If the scene of the file differs unexpectedly, returns one line
  /// that names the differences. Throws UsageError for files that do not fit the scene, and if the
  /// run needs more than the spins to continue exactly and there is no checkpoint.
  std::optional<std::string> continue_from(std::filesystem::path const& file);
  /// Returns true if the replicas need more than their spins to continue exactly.
  bool remembers() const { return first().remembers(); }

  /// Returns how many replicas' states to ask for at a time.
  std::size_t states_at_once() const;
  /// Returns what the replicas from number `first` on, states_at_once() of them at most, need to
  /// continue exactly. Throws NumbersFailed if the guard refuses a state.
  std::vector<io::ReplicaState> states(std::size_t first);

  /// Returns the first warning of a replica about its steps, with the replica's number. If the
  /// replicas are columns with different values, only those whose steps may be the least accurate
  /// are checked: the one with the most noise, and those with the largest fields and dampings.
  /// Throws the warning as io::SceneError if the scene sets refuse_unstable.
  std::optional<std::string> warning() const;

  /// Returns the number of steps that every replica has taken, not counting replicas that ended
  /// early. If all ended early, returns the largest number of steps.
  std::int64_t steps() const { return steps_; }
  std::int64_t last_step() const { return first().last_step(); }
  /// Returns the largest number of steps that a replica has taken, not counting replicas that ended
  /// early. It is larger than steps() after an interrupt, also in a run that continues from there.
  std::int64_t furthest() const;
  double time() const { return first().time_at(steps_); }  // at steps()
  std::int64_t evaluations() const;
  double step_seconds() const;
  /// Returns true if every replica has ended early, because its torque fell below until_torque.
  bool is_at_rest() const;

  /// Returns when advance() checks the replicas: at its last step, and before that only every 100
  /// steps, because a check of a small lattice takes as long as a step. If `until_torque` is true
  /// and the scene has that key, it checks after every step, or after every tenth step if a replica
  /// has more than 4096 sites.
  Looks looks(bool until_torque, std::function<bool()> interrupted) const;

  /// Throws UsageError if the replicas cannot take `count` more steps, as SceneRun does. Some
  /// replicas may already be beyond steps().
  void require_reachable(std::int64_t count) const { first().require_reachable(count, steps_); }

  /// Advances all replicas to step steps() + count. With looks.until_torque, those that have ended
  /// early stay where they are. If one fails or is interrupted, others may already be beyond
  /// steps(); when the run goes on, these wait until all have caught up.
  Advanced advance(std::int64_t count, Looks const& looks);

  /// Moves each replica to its own equilibrium; small ones are moved side by side. If one is
  /// interrupted, others may not have moved yet. Throws what SceneRun::relax throws.
  std::vector<Minimum> relax(RelaxSettings const& settings);

  std::vector<io::Scalars> scalars();
  /// Returns the spins of all replicas, packed as (replica, nz, ny, nx, 3), in the precision of the
  /// run.
  std::vector<std::byte> spins();

 private:
  std::int64_t number_of(std::size_t run) const {
    return share_.own.first + static_cast<std::int64_t>(run);
  }
  /// Returns the scene of the whole ensemble's first replica.
  io::Scene scene_of_first() const;
  /// Throws UsageError if the vacant sites of these replicas, from a file, are not the scene's.
  void require_vacancies(std::filesystem::path const& file, std::vector<double> const& spins) const;
  /// Continues from the states of the replicas in a checkpoint.
  void restore(std::vector<io::ReplicaState> const& states);
  Advanced advance_runs(std::int64_t target, Looks const& looks);
  Advanced advance_columns(std::int64_t target, Looks const& looks);
  /// Computes the value of steps() from the steps of the runs.
  std::int64_t steps_of_all() const;
  void check_columns();
  /// Replaces the columns by a run for each replica, which continues from the replica's state.
  void leave_columns();

  io::Scene scene_;
  RunSettings settings_;
  ReplicaShare share_;
  std::vector<std::unique_ptr<SceneRun>> runs_;  // if there are columns: only the first one
  std::optional<ReplicaColumns> columns_;
  std::vector<Guard> guards_;    // one for each replica in columns
  std::vector<Sample> samples_;  // one for each replica in columns, at steps(); or empty
  std::vector<bool> at_rest_;
  double seconds_of_columns_ = 0;  // step_seconds() of columns that runs have replaced
  std::atomic<std::int64_t> steps_ = 0;
};

}  // namespace cayspin::simulation
