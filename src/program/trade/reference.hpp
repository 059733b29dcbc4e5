// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "fine_solution.hpp"

namespace cayspin::program::trade {

/// A part of a scene's run from its start on, and what a coarse run of it tells.
struct Horizon {
  double time = 0;
  std::int64_t own_steps = 0;    // of tsit5 at a tolerance of 0.01: how much there is to resolve
  double seconds = 0;            // that it took
  std::string why_shorter = {};  // empty where it is the scene's end

  void halve(std::string why);
};

/// tsit5 in a form whose error follows its tolerance.
Candidate fine_tsit5();

/// The longest halving of the end that a coarse run covers in `seconds`, or in ten steps.
Horizon horizon_within(Pilot const& pilot, double seconds);

/// A converged solution of a scene, up to its end or as far as there is one.
struct Reference {
  Horizon horizon;
  FineSolution solution;
  double uncertainty;  // distance of the solutions of two methods
};

/// Halves the horizon until two methods at their tightest agree, and take no more than `seconds`.
Reference converged_reference(Pilot const& pilot, double seconds);

}  // namespace cayspin::program::trade
