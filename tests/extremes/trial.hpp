// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "integrator.hpp"
#include "simulation/plan.hpp"
#include "situation.hpp"

namespace cayspin::extremes {

/// Result of one integrator in one situation.
struct Outcome {
  Fate fate;
  std::int64_t step = -1;      // at which the run was stopped
  std::int64_t steps = 0;      // over which round-off in |m| may accumulate
  double norm = 0, error = 0;  // of the end: | |m| - 1 | and distance to the solution, in epsilons
  std::string message = {};    // why it was refused or stopped
};

/// Runs the scene of a situation like `cayspin run`, but without a trajectory file.
Outcome try_out(Integrator const& integrator, Situation const& situation, Precision precision);

/// Relaxes the scene of a situation, like `cayspin relax`.
Outcome try_to_relax(Integrator const& integrator, Situation const& situation, Precision precision);

}  // namespace cayspin::extremes
