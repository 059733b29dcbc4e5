// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/zero.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stepper/runge_kutta.hpp>
#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stepper/update.hpp>

namespace cayspin {

/// Geometric Euler, order 1: m <- cay(dt xi) m, xi = A(m) + sigma m.
/// Lewis and Nigam 2002, Sec. 4.2.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class LieEuler : public RungeKutta<Spins, tableau::Euler, update::Lie<Rotation>, Isotropy> {
 public:
  explicit LieEuler(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : LieEuler::RungeKutta("LieEuler", like, isotropy) {}
};

}  // namespace cayspin
