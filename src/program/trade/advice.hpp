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
  std::int64_t memory = 0;  // of the choice, in bytes
  bool measured = true;     // otherwise the error is an extrapolation from other steps
};

struct AdviceRequest {
  double error = 1e-4;
  std::optional<double> budget;        // seconds that the run may take
  std::optional<Precision> precision;  // the only one to try
  TrialProgress* progress = nullptr;
};

/// Result of a search, and its horizon.
struct Advised {
  std::optional<Advice> choice;  // empty if nothing meets the error, or the budget
  std::vector<Advice> others;    // cheapest first
  double horizon = 0;
  std::string why_shorter;
  double seconds = 0;  // duration of the search
};

/// Tries the candidates with coarse steps, compares them with one fine solution, and continues with
/// those predicted to be the cheapest. Takes at most a tenth of the duration of the run, or 2 s if
/// that is longer, plus the trials that measure the advice; longer only if nothing has met the
/// error by then.
Advised advise(Pilot const& pilot, AdviceRequest const& request);

}  // namespace cayspin::program::trade
