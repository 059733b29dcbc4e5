// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "candidate.hpp"
#include "simulation/simulate.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// Steps at which a run's spins are stored.
struct Looks {
  std::int64_t intervals;           // number of equal intervals: the steps of an adaptive run
  std::vector<std::int64_t> steps;  // ascending, including the last step
};

/// Part of a scene's run, starting at `begin`.
struct Stretch {
  double begin, length;
  std::vector<double> const& start;  // (sites, 3)
  Looks looks;
  bool guarded = false;  // true: the run fails if the guard of `cayspin run` would stop it
};

/// How often a run is repeated to measure its time. The shortest time counts. Runs that fail or
/// take more than 0.3 s are not repeated, and no run is done more than a hundred times.
struct Repeats {
  int least = 1;       // number of runs, even if they take longer than `seconds`
  double seconds = 0;  // runs are repeated until all together have taken this long
};

/// Result of a run without files.
struct Outcome : Ending {
  std::vector<std::vector<double>> states;  // spins at the stored steps, each (sites, 3)

  double seconds() const { return summary.step_seconds; }
};

/// Returns the largest distance between corresponding spins of two states.
double distance(std::vector<double> const& a, std::vector<double> const& b);
/// Returns the largest such distance at any stored step; infinite if a run has failed.
double distance(Outcome const& a, Outcome const& b);

/// Runs one scene with different methods, in one execution space. Exists only inside a
/// KokkosSession.
class Pilot {
 public:
  /// `error`: the smallest error that will be requested. Throws io::SceneError for a scene without
  /// steps or with a temperature, and if there is too little memory.
  Pilot(io::Scene scene, std::string space, double error);

  io::Scene const& scene() const { return scene_; }
  std::vector<double> const& start() const { return start_; }
  double end() const;
  TimeFeatures const& features() const { return *features_; }
  /// Returns the longest constant step: the scene's max_dt or, if that is shorter, the shortest
  /// feature of its field.
  double longest_step() const;
  /// Returns true if the run up to `horizon` shows all features of the fields that depend on t.
  bool is_representative(double horizon) const;
  /// Returns true if there is memory for a candidate's runs.
  bool fits(Candidate const& candidate) const;

  /// Runs a candidate, and stores only the final state.
  Outcome run(Candidate const& candidate, double horizon, Steps const& steps,
              Repeats const& repeats = {}) const;
  Outcome run(Candidate const& candidate, Stretch const& stretch, Steps const& steps,
              Repeats const& repeats = {}) const;
  /// Returns the plan of a candidate's run.
  Plan plan(Candidate const& candidate, double horizon, Steps const& steps) const;

 private:
  /// Returns the memory, in bytes, of a run and of all states that are stored at the same time.
  std::int64_t bytes(Candidate const& candidate) const;

  io::Scene scene_;
  std::string space_;
  double error_;
  std::shared_ptr<TimeFeatures const> features_;
  std::int64_t available_;
  std::vector<double> start_;
};

}  // namespace cayspin::program::trade
