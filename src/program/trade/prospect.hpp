// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "candidate.hpp"

#include <vector>

namespace cayspin::program::trade {

/// What is known of a candidate, and what that promises. Resolution: its number of steps, or
/// 1 / tolerance.
class Prospect {
 public:
  /// `order`, `cost_order`: of error and cost in the resolution. `evaluations`: expected to be
  /// needed, for as long as nothing was tried.
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

  /// Keeps a try, whose error is known up to `unknown`.
  void add(Try one, double unknown);
  /// A run with these steps took so long.
  void add_time(Steps const& steps, double seconds);

  /// The coarsest try from which on all have at most this error; nullptr: none has.
  Try const* passing(double error) const;
  /// Steps with this error, as far as can be told. They need not be allowed.
  Steps needed(double error) const;
  /// From the shortest time per evaluation of all tries.
  double seconds_of(Steps const& steps) const;
  /// The next to try: those needed, if they do not take far longer than the finest try.
  Steps next(double error) const;
  /// Does the passing try take about as long as what is needed?
  bool is_settled(double error, double goal) const;
  /// Finer steps that change the result by no less.
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
