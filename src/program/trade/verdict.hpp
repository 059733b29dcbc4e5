// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "advice.hpp"

#include <optional>
#include <vector>

namespace cayspin::program::trade {

/// Comparison of the advice for an error with the ladders.
struct Verdict {
  double asked;
  Advised advised;
  double error = 0, seconds = 0;  // of the advised run
  double best = 0;                // seconds; the shortest time of all ladders
};

/// `pilot`: runs the scene up to the reference's horizon, where the ladders end. The advised run
/// and the best ladders are timed again alternately, so that noise affects all equally.
Verdict judge(Pilot const& pilot, Reference const& reference, std::vector<Ladder> const& ladders,
              double asked, std::optional<Precision> precision);

}  // namespace cayspin::program::trade
