// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "candidate.hpp"

#include <vector>

namespace cayspin::program::trade {

/// Trials of a candidate, and predictions from them. Resolution means the number of steps or, for
/// an adaptive method, 1 / tolerance.
class Prospect {
 public:
  /// `order`, `cost_order`: the error falls as resolution^-order, and the cost grows as
  /// resolution^cost_order. `evaluations`: the number of evaluations expected before any trial.
  Prospect(Candidate const& candidate, Steps const& coarsest, Steps const& first, double order,
           double cost_order, double evaluations)
      : candidate_(candidate),
        coarsest_(coarsest),
        first_(first),
        order_(order),
        cost_order_(cost_order),
        evaluations_(evaluations) {}

  Candidate const& candidate() const { return candidate_; }
  double expected_evaluations() const { return evaluations_; }
  std::vector<Try> const& tries() const { return tries_; }
  bool is_timed_twice() const { return timed_twice_; }
  bool is_dropped() const { return dropped_; }
  void drop() { dropped_ = true; }

  /// Adds a trial, whose error is known to within `unknown`.
  void add(Try one, double unknown);
  /// Adds the duration of another run of the trial with these steps. The shorter one counts.
  void add_time(Steps const& steps, double seconds);

  /// Returns the coarsest trial such that it and all finer ones have at most this error; nullptr if
  /// there is none.
  Try const* passing(double error) const;
  /// Returns the steps predicted to have this error. allows() may refuse them.
  Steps needed(double error) const;
  /// Returns the predicted duration of a run with these steps, from the shortest time per
  /// evaluation of all trials.
  double seconds_of(Steps const& steps) const;
  /// Returns the next steps to try: those predicted to have this error, or coarser ones if these
  /// would cost more than five times as much as the finest trial.
  Steps next(double error) const;
  /// Returns true if the predicted steps, needed(goal), are hardly cheaper than the trial
  /// passing(error).
  bool is_settled(double error, double goal) const;
  /// Returns true if finer steps no longer reduce the error, because of round-off.
  bool is_round_off(double error) const;
  bool allows(Steps const& steps) const;

 private:
  double resolution(Steps const& steps) const;
  Steps steps_of(double resolution) const;
  double seen_order() const;
  double between(Try const& failing, Try const& passing, double error) const;

  Candidate candidate_;
  Steps coarsest_, first_;
  double order_, cost_order_, evaluations_;
  std::vector<Try> tries_;  // from coarse to fine
  bool dropped_ = false, timed_twice_ = false;
};

}  // namespace cayspin::program::trade
