// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "program/progress.hpp"
#include "reference.hpp"

#include <vector>

namespace cayspin::program::trade {

/// One run of a ladder, with certain steps.
struct Rung : Try {
  double dt = 0;          // 0 for adaptive methods
  bool on_front = false;  // no other run is faster and at least as accurate
};

/// Errors and costs of a candidate with finer and finer steps.
struct Ladder {
  Candidate candidate;
  std::vector<Rung> rungs;
};

inline constexpr Repeats measured_well{3, 5e-3};

struct LadderLimits {
  double least_error = 1e-9;  // after a run with a smaller error, no finer steps are run
  double seconds = 10;        // after a run that takes longer, no finer steps are run
  double far_behind = 30;     // no finer steps after a run this many times slower than others
  int rungs = 40;
  TrialProgress* progress = nullptr;
  double share = 0;  // fraction of all ladders that are done
};

/// Return the steps of a candidate's first rung, which are the coarsest, and those of the rung that
/// follows one with `steps`.
Steps coarsest_steps(Pilot const& pilot, Candidate const& candidate, double horizon,
                     std::int64_t own_steps);
Steps finer(Candidate const& candidate, Steps const& steps);

/// Runs a candidate with finer and finer steps, until a limit is reached. `others`: the ladders of
/// the candidates that have been run before.
Ladder climb(Pilot const& pilot, Candidate const& candidate, Reference const& reference,
             std::vector<Ladder> const& others, LadderLimits const& limits = {});

/// Marks the Pareto front of all rungs, by error and seconds.
void mark_front(std::vector<Ladder>& ladders);

/// Returns the time that a ladder's candidate takes to reach an error, interpolated logarithmically
/// between rungs; infinite if no rung reaches the error.
double seconds_to(Ladder const& ladder, double error);
/// Returns the ladder with only the rungs that determine seconds_to: two, one or none.
Ladder around(Ladder const& ladder, double error);
double evaluations_to(Ladder const& ladder, double error);

}  // namespace cayspin::program::trade
