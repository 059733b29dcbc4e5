// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scene_run.hpp"

#include <cstddef>
#include <cstdint>
#include <exception>
#include <memory>
#include <optional>
#include <vector>

namespace cayspin::simulation {

/// The replicas of a scene with [ensemble] as the columns of a few lattices: x counts replicas, y
/// and z are the axes of the scene's lattice. A kernel then steps as many replicas at once as a
/// register has lanes, and a launch serves all of a lattice. The spacing along x is so large that
/// exchange along x vanishes. Each replica has the bits of a run of its own.
class ReplicaColumns {
 public:
  /// `one`: the scene of the first replica. Empty if the lattice has three axes or many sites, if a
  /// term or the method depends on more than a site and its exchange, or if replicas differ by more
  /// than seeds and temperatures.
  static std::optional<ReplicaColumns> open(io::Scene const& scene, io::Scene const& one,
                                            RunSettings const& settings);

  /// Those of the replicas, reduced; empty if all have that of the scene.
  std::vector<double> const& temperatures() const { return temperatures_; }

  /// Steps that all replicas have taken.
  std::int64_t steps() const;
  std::int64_t evaluations() const;
  double step_seconds() const;

  /// Tells whether steps ended early, and why.
  struct Ended {
    bool interrupted = false;
    std::vector<std::int64_t> failed;  // replicas of the lattices that failed
    std::exception_ptr error = {};     // of the first of these
  };
  /// Advances to step `target`. A lattice in which a replica fails stays before the step that
  /// failed.
  Ended advance(std::int64_t target, Looks const& looks);

  /// Continues after this step from the spins of all replicas, one after the other.
  void continue_from(std::int64_t step, std::vector<double> const& spins);

  /// Moves a run of one replica to the step and the spins of that replica.
  void continue_in(SceneRun& run, std::int64_t replica) const;

  /// Samples all replicas, in their order.
  std::vector<Sample> samples() const;
  /// The spins of all replicas, one after the other, each as packed().
  template <class Real>
  std::vector<Real> spins() const;

 private:
  struct Group {
    std::int64_t first, count;
    std::unique_ptr<SceneRun> columns, one;
  };
  std::vector<Group> groups_;
  std::vector<double> temperatures_;
};

}  // namespace cayspin::simulation
