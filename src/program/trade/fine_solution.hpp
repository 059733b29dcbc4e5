// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pilot.hpp"

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program::trade {

/// A solution by tsit5 up to a horizon, at a tolerance below the errors to be measured. What
/// relaxes early is seen, too: half of its times are in the first quarter.
class FineSolution {
 public:
  /// Of the horizon, in parts of `parts`.
  static constexpr std::int64_t parts = 1024;
  static constexpr std::array<std::int64_t, 12> times{1,   4,   16,  64,  128, 256,
                                                      384, 512, 640, 768, 896, parts};

  /// Tightens the tolerance until two of them agree to a tenth of `error`, if they do.
  FineSolution(Pilot const& pilot, double horizon, double error);

  /// Estimated, by the one at ten times the tolerance.
  double error() const { return error_; }
  double tolerance() const { return tolerance_; }
  std::optional<std::string> const& failure() const { return solution_.failure; }

  /// A candidate's run to the horizon, kept at its first step, and the first from these times on.
  Stretch stretch(Candidate const& candidate, Steps const& steps) const;
  /// The largest distance of any spin in such a run, at any step that was kept.
  double distance_of(Outcome const& outcome, Candidate const& candidate, Steps const& steps) const;

 private:
  std::vector<double> at(std::int64_t step, std::int64_t steps) const;

  Pilot const& pilot_;
  double horizon_, tolerance_ = 0, error_;
  Outcome solution_;
};

}  // namespace cayspin::program::trade
