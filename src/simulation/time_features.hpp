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

namespace cayspin::inline v0_2::io {
struct Scene;
}

namespace cayspin::simulation {

/// Features of a scene's fields and currents in time, which a method might miss between its
/// evaluations.
struct TimeFeatures {
  struct Shortest {
    double length, time;  // width at half height, and time of the extreme
    std::string key;      // of the vector, in the scene
  };

  std::vector<StepBound> bounds;  // steps within these bounds miss no feature
  std::int64_t jumps = 0;
  double last_change = 0;  // everything is constant from then on
  std::optional<Shortest> shortest;
  std::vector<std::pair<std::string, double>> largest;  // key and largest length of a vector
  std::optional<std::string>
      unresolved;  // the key of a vector that changes too fast to be resolved
};

/// A vector that depends on t, and its key.
struct TimeDependent {
  std::string key;
  std::function<void(double t, double* three)> value;  // NaN where not finite
  // Candidate times of events: numbers in its expressions, and their sums and differences.
  std::vector<double> events;
};

struct FeatureSearch {
  double begin = 0, end = 0;  // of the run, or of a stage of it
  double angle = 1e-10;       // radians: features that turn spins by less are ignored
  std::int64_t samples = std::int64_t{1} << 20;
  std::int64_t most_evaluations = 5'000'000;
};

/// Samples the vectors at equally spaced times and near their events, locates jumps by bisection,
/// and divides the time between jumps until polynomials follow the vectors in each part.
TimeFeatures find_features(std::span<TimeDependent const> vectors, FeatureSearch const& search);

/// Returns the features of a scene's fields and currents up to the scene's end, for adaptive steps
/// with the tolerance `error` or, if `error` is empty, for the scene's constant steps. Empty if
/// nothing depends on t, for rigid bodies, for scenes without steps, and if a vector is not finite.
/// Later calls for the same fields are fast, unless a function of the program is among them.
std::shared_ptr<TimeFeatures const> features_of(io::Scene const& scene,
                                                std::optional<double> error);

}  // namespace cayspin::simulation
