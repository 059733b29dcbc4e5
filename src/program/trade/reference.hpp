// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "pilot.hpp"

namespace cayspin::program::trade {

/// A converged solution of a scene, up to its end or as far as there is one.
struct Reference {
  Outcome solution;
  double horizon = 0;
  double uncertainty = 0;      // distance of the solutions of two methods
  std::int64_t own_steps = 0;  // of tsit5 at a tolerance of 0.01: how much there is to resolve
  std::string why_shorter;     // empty where the horizon is the scene's end
};

/// Halves the horizon until two methods at their tightest agree, and take no more than `seconds`.
Reference converged_reference(Pilot const& pilot, double seconds);

/// The longest halving of the end that a coarse run covers in `seconds`, and the own steps of one.
Reference horizon_alone(Pilot const& pilot, double seconds);

}  // namespace cayspin::program::trade
