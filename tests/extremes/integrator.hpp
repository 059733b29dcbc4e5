// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/method_choice.hpp"
#include "simulation/variant.hpp"

#include <string>
#include <vector>

namespace cayspin::extremes {

using namespace simulation;

/// One integrator as a scene can ask for it.
struct Integrator : MethodChoice {
  bool of_rigid_bodies = false;
  bool relaxes = false;  // to a state of rest, by no method

  /// The method with its isotropy, and with its chart.
  std::string name() const;
  /// Generator and rotation, where the method takes some.
  std::string variant() const;
};

/// Every method of the program that takes steps of dt, with every generator and rotation it takes.
std::vector<Integrator> with_equal_steps();

/// The same of those that choose their steps.
std::vector<Integrator> with_adaptive_steps();

/// `cayspin relax`.
Integrator relaxation();

}  // namespace cayspin::extremes
