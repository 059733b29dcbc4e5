// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pilot.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// Returns the times at which runs are compared, in units of horizon / 1024: a dozen, and up to
/// sixteen more just after a field jumps or has its shortest feature.
std::vector<std::int64_t> times_of_looks(TimeFeatures const& features, double horizon);

/// A solution by an adaptive method up to a horizon, with which runs are compared.
///
/// Runs are compared after their first step, and after the first step that ends at or after each
/// of times_of_looks, so that the error covers the whole motion. Motion that decays does so early,
/// hence half of the times are in the first quarter: at four equally spaced times, any stable step
/// would pass. Steps need not end exactly at these times, since that would exclude coarse ones; the
/// solution is continued to where they end.
class FineSolution {
 public:
  static constexpr std::int64_t parts = 1024;  // parts of the horizon, as in times_of_looks()

  FineSolution(Pilot const& pilot, double horizon, Candidate const& by, double tolerance);

  double tolerance() const { return tolerance_; }
  double seconds() const { return solution_.seconds(); }
  std::optional<std::string> const& failure() const { return solution_.failure; }

  /// Returns the largest distance between corresponding spins of two solutions, at any of the
  /// times_of_looks().
  double distance_to(FineSolution const& other) const {
    return distance(solution_, other.solution_);
  }

  /// From now on continues the solution by constant steps of `method`. These are the longest, of
  /// those tried, whose error is at most `error` at all times at which they can be compared. If
  /// none meets `error`, changes nothing. For short continuations, constant steps are cheaper than
  /// adaptive ones.
  void continue_by(Candidate const& method, double error);

  /// Measures a candidate's run to the horizon. `guarded`: the run fails if the guard of `cayspin
  /// run` would stop it.
  Try measure(Candidate const& candidate, Steps const& steps, bool guarded,
              Repeats const& repeats) const;

 private:
  std::vector<double> at(std::int64_t step, std::int64_t steps) const;

  Pilot const* pilot_;
  Candidate by_;
  double horizon_, tolerance_;
  std::vector<std::int64_t> times_;
  Outcome solution_;
  std::int64_t equal_steps_ = 0;  // number of constant steps up to the horizon; 0: adaptive steps
};

/// The first part of a scene's run, and the results of a coarse run over that part.
struct Horizon {
  double time = 0;
  // Steps of tsit5 at a tolerance of 0.01: a measure of how much there is to resolve.
  std::int64_t own_steps = 0;
  double seconds = 0;            // duration of this coarse run
  std::string why_shorter = {};  // empty if `time` is the scene's end

  void halve(std::string why);
};

/// Returns tsit5 with the tangent generator, whose error follows its tolerance.
Candidate fine_tsit5();

/// Returns the longest horizon tried that a coarse run covers within `seconds` or within ten steps.
/// Tries the scene's end / 2^n, where n starts at 20 and falls by at most four at a time. If even
/// the first run takes longer, returns its horizon. Throws NumbersFailed if a coarse run fails.
Horizon horizon_within(Pilot const& pilot, double seconds);

/// A converged solution of a scene, up to its end or as far as it converges.
struct Reference {
  Horizon horizon;
  FineSolution solution;
  double uncertainty;  // distance between the solutions of two methods
};

/// Returns the reference solution. Starts from a horizon that a coarse run covers in a tenth of
/// `seconds`, and halves it until two methods at a tolerance of 1e-13 agree. Throws NumbersFailed
/// if they never do.
Reference converged_reference(Pilot const& pilot, double seconds);

}  // namespace cayspin::program::trade
