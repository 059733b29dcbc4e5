// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stepper/step_bounds.hpp>

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_1::io {
struct Scene;
}

namespace cayspin::simulation {

/// What a scene's fields and currents do between the times that a method evaluates them at.
struct TimeFeatures {
  struct Shortest {
    double length, time;  // of the shortest pulse or half period: its width at half height
    std::string key;      // of the scene
  };

  std::vector<StepBound> bounds;  // by which no step of a method misses a feature
  std::int64_t jumps = 0;
  double last_change = 0;  // from then on all is constant
  std::optional<Shortest> shortest;
  std::vector<std::pair<std::string, double>> largest;  // length of the vector of each key
  std::optional<std::string> unresolved;  // the key of what changes too fast to be looked at
};

/// A vector that depends on t, and the key that gives it.
struct TimeDependent {
  std::string key;
  std::function<void(double t, double* three)> value;  // NaN where it is not finite
  std::vector<double> events;  // where something may happen: numbers in an expression
};

struct FeatureSearch {
  double end = 0;        // of the run
  double angle = 1e-10;  // radians: features that turn spins by less are left out
  std::int64_t samples = std::int64_t{1} << 20;
  std::int64_t most_evaluations = 5'000'000;
};

/// Looks at the vectors at equal times and near their events, bisects jumps, and divides the time
/// between jumps until polynomials follow the vectors in each part.
TimeFeatures find_features(std::span<TimeDependent const> vectors, FeatureSearch const& search);

/// The features of a scene's fields and currents up to its end, for adaptive steps that keep to
/// `error`, or for the scene's equal steps where none is given. Empty where nothing depends on t.
/// Later calls for the same fields are fast.
std::shared_ptr<TimeFeatures const> features_of(io::Scene const& scene,
                                                std::optional<double> error);

}  // namespace cayspin::simulation
