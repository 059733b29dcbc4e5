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

/// A method in one precision, whose steps are still to be chosen.
struct Candidate : MethodChoice {
  Precision precision = Precision::double_precision;

  double least_tolerance() const;
  /// Returns an estimate of the error of a run due to round-off. The candidate is not tried for
  /// smaller errors.
  double least_error() const { return 2 * least_tolerance(); }
  /// Returns a name such as "rkmk4 tangent, single" or "rkmk4, multirate, 4 substeps".
  std::string name() const;
};

/// Steps of a candidate: a number of equal steps, or a tolerance.
struct Steps {
  std::int64_t count = 0;
  double tolerance = 0;
};

/// Result of a candidate's run; infinite error if it failed.
struct Try {
  Steps steps;
  double error = infinite;
  double seconds = 0;
  std::int64_t evaluations = 0;
};

/// Returns all candidates that can run a scene: those in double precision, then those in single
/// precision, each by falling order. If `precision` is given, returns only those in this precision.
/// If `in_parts`, returns only those that run on several ranks. Some candidates evaluate an
/// expensive field once a step, others in each stage.
std::vector<Candidate> candidates(io::Scene const& scene, std::optional<Precision> precision = {},
                                  bool in_parts = false);

/// Returns the scene with a candidate as its method and `horizon` as its end. For an adaptive
/// method, `intervals` equal intervals become the steps of the scene.
io::Scene with(io::Scene scene, Candidate const& candidate, double horizon, std::int64_t intervals,
               Steps const& steps);

}  // namespace cayspin::program::trade
