// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "program/progress.hpp"
#include "reference.hpp"

#include <vector>

namespace cayspin::program::trade {

/// One run of a ladder.
struct Rung : Try {
  double dt = 0;          // of methods with equal steps
  bool on_front = false;  // nothing is both faster and more accurate
};

/// A candidate's error and cost, from its coarsest steps on.
struct Ladder {
  Candidate candidate;
  std::vector<Rung> rungs;
};

inline constexpr Repeats measured_well{3, 5e-3};

struct LadderLimits {
  double least_error = 1e-9;  // nothing finer is run
  double seconds = 10;        // nor anything that takes longer
  double far_behind = 30;     // nor by a candidate so many times slower than another
  int rungs = 40;
  TrialProgress* progress = nullptr;
  double share = 0;  // of all ladders that is done
};

/// Steps that a candidate's ladder begins with, as coarse as may be; and those of the next rung.
Steps coarsest_steps(Pilot const& pilot, Candidate const& candidate, double horizon,
                     std::int64_t own_steps);
Steps finer(Candidate const& candidate, Steps const& steps);

/// `others`: what has been climbed before.
Ladder climb(Pilot const& pilot, Candidate const& candidate, Reference const& reference,
             std::vector<Ladder> const& others, LadderLimits const& limits = {});

/// Marks the Pareto front of all rungs, by error and seconds.
void mark_front(std::vector<Ladder>& ladders);

/// What a ladder's candidate takes to an error, between rungs by logarithms; infinite where it
/// does not get there.
double seconds_to(Ladder const& ladder, double error);
/// The ladder with the rungs alone from which that comes: two, one or none.
Ladder around(Ladder const& ladder, double error);
double evaluations_to(Ladder const& ladder, double error);

}  // namespace cayspin::program::trade
