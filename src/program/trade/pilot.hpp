// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "candidate.hpp"
#include "simulation/simulate.hpp"

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// When a run's spins are kept.
struct Looks {
  std::int64_t intervals;           // equal ones, that adaptive methods take for steps
  std::vector<std::int64_t> steps;  // ascending, the last step among them
};

/// A part of a scene's run, from `begin` on.
struct Stretch {
  double begin, length;
  std::vector<double> const& start;  // (sites, 3)
  Looks looks;
  bool guarded = false;  // does it fail where `cayspin run` stops?
};

/// How often a run is repeated, to measure its time: the shortest counts.
struct Repeats {
  int least = 1;
  double seconds = 0;  // in all, of what takes less
};

/// What a run without files came to.
struct Outcome : Ending {
  std::vector<std::vector<double>> states;  // at the looks, (sites, 3)

  double seconds() const { return summary.step_seconds; }
};

/// The largest distance of any spin.
double distance(std::vector<double> const& a, std::vector<double> const& b);
/// The same at any look; infinite where one of them is not finite.
double distance(Outcome const& a, Outcome const& b);

/// Runs one scene by one method and another, in one execution space, inside a KokkosSession.
class Pilot {
 public:
  /// `error`: the smallest that is asked for. Throws io::SceneError for a scene without steps or
  /// with a temperature, and where memory does not suffice.
  Pilot(io::Scene scene, std::string space, double error);

  io::Scene const& scene() const { return scene_; }
  std::vector<double> const& start() const { return start_; }
  double end() const;
  TimeFeatures const& features() const { return *features_; }
  /// Of equal steps: the scene's max_dt, or the shortest feature of its field.
  double longest_step() const;
  /// Does what depends on t do up to `horizon` all that it does up to the end?
  bool is_representative(double horizon) const;
  /// Is there memory for a candidate's runs?
  bool fits(Candidate const& candidate) const;

  /// Seen at its end.
  Outcome run(Candidate const& candidate, double horizon, Steps const& steps,
              Repeats const& repeats = {}) const;
  Outcome run(Candidate const& candidate, Stretch const& stretch, Steps const& steps,
              Repeats const& repeats = {}) const;
  /// What is known of such a run beforehand.
  Plan plan(Candidate const& candidate, double horizon, Steps const& steps) const;

 private:
  /// Of a run, and of the states that are kept of two.
  std::int64_t bytes(Candidate const& candidate) const;

  io::Scene scene_;
  std::string space_;
  double error_;
  std::shared_ptr<TimeFeatures const> features_;
  std::int64_t available_;
  std::vector<double> start_;
};

}  // namespace cayspin::program::trade
