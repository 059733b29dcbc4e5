// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/method_choice.hpp"
#include "simulation/variant.hpp"

#include <string>
#include <vector>

namespace cayspin::extremes {

using namespace simulation;

/// An integrator that a scene can ask for.
struct Integrator : MethodChoice {
  bool of_rigid_bodies = false;
  bool relaxes = false;  // minimises instead of using a method

  /// Returns the method's name, with its isotropy and whether it is tangent, compensated, or for
  /// bodies.
  std::string name() const;
  /// Returns the generator and the rotation; an empty text if the method has no choice of them.
  std::string variant() const;
};

/// Returns every method of the program with constant steps, with every generator and rotation that
/// it accepts.
std::vector<Integrator> with_equal_steps();

/// Returns every method with adaptive steps, with every generator and rotation that it accepts.
std::vector<Integrator> with_adaptive_steps();

/// Returns the integrator that stands for `cayspin relax`.
Integrator relaxation();

}  // namespace cayspin::extremes
