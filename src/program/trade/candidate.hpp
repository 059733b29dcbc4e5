// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/method_choice.hpp"
#include "simulation/plan.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

using namespace simulation;

inline constexpr double infinite = std::numeric_limits<double>::infinity();

/// A choice in one precision, whose steps are still to be chosen.
struct Candidate : MethodChoice {
  Precision precision = Precision::double_precision;

  double least_tolerance() const;
  /// Round-off of a run comes up to here: no smaller error is asked of the candidate.
  double least_error() const { return 2 * least_tolerance(); }
  /// Such as "rkmk4 tangent, single" or "rkmk4, dear, 4 substeps".
  std::string name() const;
};

/// How a candidate steps: so many equal steps, or as the tolerance asks for.
struct Steps {
  std::int64_t count = 0;
  double tolerance = 0;
};

/// A run of a candidate; infinite error where it failed.
struct Try {
  Steps steps;
  double error = infinite;
  double seconds = 0;
  std::int64_t evaluations = 0;
};

/// All that can run a scene, those of high order first; in one precision, where that is given. A
/// dear field is evaluated once a step of some, and in each stage of others.
std::vector<Candidate> candidates(io::Scene const& scene, std::optional<Precision> precision = {});

/// The scene up to `horizon` by a candidate; adaptive ones are looked at after so many equal
/// intervals.
io::Scene with(io::Scene scene, Candidate const& candidate, double horizon, std::int64_t intervals,
               Steps const& steps);

}  // namespace cayspin::program::trade
