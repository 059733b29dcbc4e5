// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "ladder.hpp"

#include <optional>
#include <vector>

namespace cayspin::program::trade {

/// A method with its steps for a whole scene, and what they will come to.
struct Advice {
  Candidate candidate;
  Steps steps;  // to the scene's end
  double dt = 0;
  double error = 0;  // at the tried horizon
  double seconds = 0;
  std::int64_t memory = 0;  // bytes, of the choice
};

struct AdviceRequest {
  double error = 1e-4;
  std::optional<double> budget;        // seconds that the run may take
  std::optional<Precision> precision;  // the only one
  TrialProgress* progress = nullptr;
};

/// What was found out, at which horizon.
struct Advised {
  std::optional<Advice> choice;  // none where nothing reaches the error, or the budget
  std::vector<Advice> others;    // cheapest first
  double horizon = 0;
  std::string why_shorter;
  double seconds = 0;  // that it took to find out
};

/// Tries every candidate with coarse steps, judges their errors by one fine solution, and goes on
/// with those that promise to be the cheapest. Takes a tenth of the time of the run at most, or 2
/// s, and a try.
Advised advise(Pilot const& pilot, AdviceRequest const& request);

}  // namespace cayspin::program::trade
