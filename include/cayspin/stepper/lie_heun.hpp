// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/energy.hpp>
#include <cayspin/isotropy/zero.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stepper/runge_kutta.hpp>
#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stage/update.hpp>

namespace cayspin {

/// Geometric Heun, order 2: F = dt (xi(m) + xi(cay(dt xi(m)) m)) / 2, m <- cay(F) m,
/// xi = A + sigma m. Lewis and Nigam 2002, Sec. 4.3.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class LieHeun
    : public RungeKutta<Spins, tableau::Heun, update::LieUncorrected<Rotation>, Isotropy> {
 public:
  explicit LieHeun(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : LieHeun::RungeKutta("LieHeun", like, isotropy) {}
};

}  // namespace cayspin
