// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "candidate.hpp"
#include "simulation/simulate.hpp"

#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// What a run without files came to.
struct Outcome : Ending {
  std::vector<std::vector<double>> states;  // at the looks, (sites, 3)

  double seconds() const { return summary.step_seconds; }
};

/// The largest distance of any spin at any look; infinite where one of them is not finite.
double distance(Outcome const& a, Outcome const& b);

/// Runs one scene by one method and another, in one execution space, inside a KokkosSession.
class Pilot {
 public:
  static constexpr std::int64_t looks = 4;

  Pilot(io::Scene scene, std::string space);

  io::Scene const& scene() const { return scene_; }
  double end() const;

  /// `repetitions`: of short runs, to measure their time.
  Outcome run(Candidate const& candidate, double horizon, Steps const& steps,
              int repetitions = 1) const;
  /// What is known of such a run beforehand.
  Plan plan(Candidate const& candidate, double horizon, Steps const& steps) const;

 private:
  io::Scene scene_;
  std::string space_;
  std::vector<double> start_;
};

}  // namespace cayspin::program::trade
