// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "ladder.hpp"

#include <optional>
#include <vector>

namespace cayspin::program::trade {

/// A method with its steps for a whole scene, and the predicted result.
struct Advice {
  Candidate candidate;
  Steps steps;  // up to the scene's end
  double dt = 0;
  double error = 0;  // up to the horizon of the trials
  double seconds = 0;
  std::int64_t memory = 0;  // in bytes; only Advised::choice has it
  bool measured = true;     // false: the error is extrapolated from other steps
  bool holds = false;       // true: the steps as resolved for the scene meet the error
};

struct AdviceRequest {
  double error = 1e-4;
  std::optional<double> budget;        // seconds that the run may take
  std::optional<Precision> precision;  // if given, only this one is tried
  TrialProgress* progress = nullptr;
  bool in_parts = false;  // true: only methods that run on several ranks
};

/// Result of a search for advice, with the horizon of its trials.
struct Advised {
  std::optional<Advice> choice;  // empty if no method meets both the error and the budget
  std::vector<Advice> others;    // cheapest first
  double horizon = 0;
  std::string why_shorter;
  double seconds = 0;  // duration of the search
};

/// Finds the cheapest method whose error is at most the requested one. Tries the candidates with
/// coarse steps, compares their results with one fine solution, and continues with those predicted
/// to be the cheapest. This search takes at most a tenth of the duration of the run, or 2 s if that
/// is longer, and continues beyond this limit only if no candidate has met the error by then. The
/// trials that check the advice itself come in addition.
Advised advise(Pilot const& pilot, AdviceRequest const& request);

}  // namespace cayspin::program::trade
