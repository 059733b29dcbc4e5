// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pilot.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// The parts of a horizon that runs are looked at after, of 1024: a dozen, and those in which an
/// applied field jumps or has its shortest feature.
std::vector<std::int64_t> times_of_looks(TimeFeatures const& features, double horizon);

/// A solution by an adaptive method up to a horizon, by which errors are measured.
///
/// Runs are looked at after their first step, and after the first steps that end at one of
/// times_of_looks or later. An error is that of frames during the whole motion. What comes to rest
/// does so early, hence half of the times are in the first quarter: at four equal times any stable
/// step would do. Steps need not end at the times, which would rule out coarse ones. The solution
/// is continued to where they end.
class FineSolution {
 public:
  static constexpr std::int64_t parts = 1024;  // of the horizon

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
  Try measure(Candidate const& candidate, Steps const& steps, bool guarded,
              Repeats const& repeats) const;

 private:
  std::vector<double> at(std::int64_t step, std::int64_t steps) const;

  Pilot const* pilot_;
  Candidate by_;
  double horizon_, tolerance_;
  std::vector<std::int64_t> times_;
  Outcome solution_;
  std::int64_t equal_steps_ = 0;  // to the horizon, of continuations; 0: they have the tolerance
};

/// A part of a scene's run from its start on, and what a coarse run of it tells.
struct Horizon {
  double time = 0;
  std::int64_t own_steps = 0;    // of tsit5 at a tolerance of 0.01: how much there is to resolve
  double seconds = 0;            // that it took
  std::string why_shorter = {};  // empty where it is the scene's end

  void halve(std::string why);
};

/// tsit5 in a form whose error follows its tolerance.
Candidate fine_tsit5();

/// The longest halving of the end that a coarse run covers in `seconds`, or in ten steps; the
/// twentieth where none does.
Horizon horizon_within(Pilot const& pilot, double seconds);

/// A converged solution of a scene, up to its end or as far as there is one.
struct Reference {
  Horizon horizon;
  FineSolution solution;
  double uncertainty;  // distance of the solutions of two methods
};

/// From a horizon that a coarse run covers in a tenth of `seconds`, halves it until two methods at
/// their tightest agree.
Reference converged_reference(Pilot const& pilot, double seconds);

}  // namespace cayspin::program::trade
