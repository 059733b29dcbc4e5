// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pilot.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// Returns the times, in units of 1/1024 horizon, at which runs are compared: a dozen, and up to
/// sixteen just after a field jumps or has its shortest feature.
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
  static constexpr std::int64_t parts = 1024;  // of the horizon

  FineSolution(Pilot const& pilot, double horizon, Candidate const& by, double tolerance);

  double tolerance() const { return tolerance_; }
  double seconds() const { return solution_.seconds(); }
  std::optional<std::string> const& failure() const { return solution_.failure; }

  /// Returns the largest distance of any spin from another solution, at any time.
  double distance_to(FineSolution const& other) const {
    return distance(solution_, other.solution_);
  }

  /// From now on continues the solution by constant steps of `method`: the longest whose error is
  /// at most `error` at all times at which they can be compared. Without such steps, changes
  /// nothing. Constant steps make short continuations cheaper than steps by the tolerance.
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
  std::int64_t equal_steps_ = 0;  // of continuations, to the horizon; 0: they use the tolerance
};

/// The first part of a scene's run, and the results of a coarse run over that part.
struct Horizon {
  double time = 0;
  std::int64_t own_steps =
      0;               // of tsit5 at a tolerance of 0.01: a measure of how much there is to resolve
  double seconds = 0;  // duration of that run
  std::string why_shorter = {};  // empty if `time` is the scene's end

  void halve(std::string why);
};

/// Returns tsit5 in a form whose error follows its tolerance.
Candidate fine_tsit5();

/// Returns a horizon that a coarse run covers in `seconds`, or in ten steps: the scene's end,
/// halved at most twenty times, after which the run may take longer. It is the longest of those
/// that were tried, up to four halvings apart. Throws NumbersFailed if a coarse run fails.
Horizon horizon_within(Pilot const& pilot, double seconds);

/// A converged solution of a scene, up to its end or as far as it converges.
struct Reference {
  Horizon horizon;
  FineSolution solution;
  double uncertainty;  // distance between the solutions of two methods
};

/// Starts from a horizon that a coarse run covers in a tenth of `seconds`, and halves it until two
/// methods at a tolerance of 1e-13 agree. Throws NumbersFailed if they never do.
Reference converged_reference(Pilot const& pilot, double seconds);

}  // namespace cayspin::program::trade
