// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble.hpp"
#include "io/ensemble_checkpoint.hpp"
#include "replica_share.hpp"
#include "scene_run.hpp"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

namespace cayspin::simulation {

/// A share of the replicas of a scene with [ensemble] as the columns of a few lattices: x counts
/// replicas, y and z are the (at most two) axes of the scene's lattice. A kernel then advances as
/// many replicas at once as a register has lanes, and one launch serves all replicas of a lattice.
/// The spacing along x is so large that exchange along x vanishes. The results of each replica are
/// bitwise identical to those of a separate run. Members count the replicas of the share from 0.
class ReplicaColumns {
 public:
  /// `one`: the scene of the share's first replica. Returns nothing if separate runs would be
  /// faster, or if columns do not support the scene: for example, if there are few replicas; if the
  /// lattice has three axes, many sites, or moments other than 1; if constants are site-dependent;
  /// if the method or a term other than exchange couples sites; or if the replicas differ in more
  /// than seeds, temperatures, dampings, constant applied fields and constants of uniaxial
  /// anisotropies.
  static std::optional<ReplicaColumns> open(io::Scene const& scene, io::Scene const& one,
                                            RunSettings const& settings, ReplicaShare const& share);

  /// Returns the values in which the replicas differ, as io::values_of_replicas does.
  io::Columns const& values() const { return values_; }

  /// Returns the number of steps that all replicas have taken.
  std::int64_t steps() const;
  /// Returns the number of steps of the replicas that have taken the most.
  std::int64_t furthest() const;
  std::int64_t evaluations() const;
  double step_seconds() const;

  /// Tells whether steps ended early, and why.
  struct Ended {
    bool interrupted = false;
    std::vector<std::int64_t> failed;  // replicas of the lattices that failed
    std::exception_ptr error = {};     // of the first lattice that failed
  };
  /// Advances to step `target`. A lattice in which a replica fails stays where SceneRun::advance
  /// leaves it.
  Ended advance(std::int64_t target, Looks const& looks);

  /// Continues after step `step` from `spins`: those of all replicas, one after the other.
  void continue_from(std::int64_t step, std::vector<double> const& spins);

  /// Returns what each replica needs to continue exactly.
  std::vector<io::ReplicaState> states() const;
  /// Restores what states(), here or of separate runs, has returned, all after the same step.
  void restore(std::vector<io::ReplicaState> const& states);

  /// Sets a separate run of a replica to the step and the spins that the replica has here.
  void continue_in(SceneRun& run, std::int64_t replica) const;

  /// Samples all replicas, in their order.
  std::vector<Sample> samples() const;
  /// Returns the spins of all replicas, one after the other, each in the order of packed().
  template <class Real>
  std::vector<Real> spins() const;

 private:
  struct Group {
    std::int64_t first, count;
    std::unique_ptr<SceneRun> columns, one;
  };
  std::vector<Group> groups_;
  io::Columns values_;
};

}  // namespace cayspin::simulation
