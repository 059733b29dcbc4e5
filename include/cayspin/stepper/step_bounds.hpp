// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2 {

/// A time interval in which steps are at most max_dt long. A longer step that would pass `begin` is
/// shortened: to max_dt if `begin` is at most max_dt away, otherwise so that steps end exactly at
/// `begin`. max_dt = 0 stands for a jump of the field between `begin` and `end`, which are a few
/// ulp of t apart: steps end at `begin`, and a new run starts at `end` with the same spins.
struct StepBound {
  double begin = 0, end = 0, max_dt = 0;
};

namespace detail {

/// Returns dt, adjusted so that steps end exactly at a time that is `left` away, and the last step
/// is not very short.
inline double step_within(double left, double dt) {
  if (dt >= left * (1 - 1e-9)) return left;
  return 2 * dt > left ? 0.5 * left : dt;
}

/// Bounds on the length of steps, in addition to their error control.
class StepBounds {
 public:
  /// Throws std::invalid_argument unless the bounds are ascending and do not overlap, with max_dt
  /// >= 0.
  StepBounds(std::vector<StepBound> bounds, std::string const& region) : all_(std::move(bounds)) {
    double last = all_.empty() ? 0 : all_.front().begin;
    for (auto const& bound : all_) {
      if (!(bound.begin >= last) || !(bound.end >= bound.begin) || !(bound.max_dt >= 0))
        throw std::invalid_argument(region +
                                    ": bounds of steps must be ascending, apart, and max_dt >= 0");
      last = bound.end;
    }
  }

  /// Returns the end of the jump at t, or t if there is no jump.
  double after_jump(double t) const {
    auto const at = first_that_ends_after(t);
    return at != all_.end() && at->max_dt == 0 && at->begin <= t ? at->end : t;
  }

  struct Step {
    double dt, end;  // end: t + dt, or exactly the start of a bound
  };
  /// Returns a step from t that is at most (1 + 1e-9) * dt long, and does not pass `end`.
  Step step(double t, double dt, double end) const {
    double stop = end;
    for (auto at = first_that_ends_after(t); at != all_.end() && at->begin < t + 2 * dt; ++at) {
      if (at->max_dt >= dt) continue;
      if (at->begin - t > at->max_dt) {
        stop = std::min(end, at->begin);
        break;
      }
      dt = at->max_dt;
    }
    dt = step_within(stop - t, dt);
    return {dt, stop < end && dt == stop - t ? stop : t + dt};
  }

 private:
  std::vector<StepBound>::const_iterator first_that_ends_after(double t) const {
    return std::ranges::upper_bound(all_, t, {}, &StepBound::end);
  }

  std::vector<StepBound> all_;
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
