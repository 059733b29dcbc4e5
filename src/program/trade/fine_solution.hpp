// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pilot.hpp"

#include <array>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// What a run came to, beside a fine solution.
struct Measured {
  std::optional<std::string> failure = {};
  double error = std::numeric_limits<double>::infinity();
  double seconds = 0;
  std::int64_t evaluations = 0;
};

/// A solution by an adaptive method up to a horizon, by which errors are measured.
///
/// Runs are looked at after their first step, and after the first steps that end at one of these
/// times or later. An error is that of frames during the whole motion. What comes to rest does so
/// early, hence half of the times are in the first quarter: at four equal times any stable step
/// would do. Steps need not end at the times, which would rule out coarse ones. The solution is
/// continued to where they end.
class FineSolution {
 public:
  static constexpr std::int64_t parts = 1024;  // of the horizon
  static constexpr std::array<std::int64_t, 12> times{1,   4,   16,  64,  128, 256,
                                                      384, 512, 640, 768, 896, parts};

  FineSolution(Pilot const& pilot, double horizon, Candidate const& by, double tolerance);

  double tolerance() const { return tolerance_; }
  double seconds() const { return solution_.seconds(); }
  std::optional<std::string> const& failure() const { return solution_.failure; }

  /// The largest distance of any spin from another one, at any time.
  double distance_to(FineSolution const& other) const {
    return distance(solution_, other.solution_);
  }

  /// From now on it is continued by equal steps of this method, as long as they can be for a run
  /// to the horizon to come within `error` of it, if there are such. Short continuations are
  /// cheaper by them than by the tolerance.
  void continue_by(Candidate const& method, double error);

  /// A candidate's run to the horizon. `guarded`: does it fail where `cayspin run` stops?
  Measured measure(Candidate const& candidate, Steps const& steps, bool guarded,
                   Repeats const& repeats) const;

 private:
  std::vector<double> at(std::int64_t step, std::int64_t steps) const;

  Pilot const* pilot_;
  Candidate by_;
  double horizon_, tolerance_;
  Outcome solution_;
  std::int64_t equal_steps_ = 0;  // to the horizon, of continuations; 0: they have the tolerance
};

}  // namespace cayspin::program::trade
