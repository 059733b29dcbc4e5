// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stepper/runge_kutta.hpp>
#include <cayspin/stage/update_compensated.hpp>

namespace cayspin {

/// A Runge-Kutta method with compensated sums, Compensated<Rkmk4<Spins>> for example: what rounding
/// takes off the spins at the end of each step is kept, and goes into the next one (Kahan 1965). So
/// round-off does not grow with the number of steps: it stays that of the increments. In float it
/// gives most of what double would, at nearly the cost of float; in double, long runs with short
/// steps. One field more of work memory, and increments are stored. Not for code compiled with
/// -ffast-math.
/// It remembers: `spins` must be what the step before left, or `reset` be called.
template <class Stepper>
requires requires {
  typename Stepper::tableau_type;
  typename Stepper::update_type;
}
class Compensated : public RungeKutta<typename Stepper::spins_type, typename Stepper::tableau_type,
                                      update::Compensated<typename Stepper::update_type>,
                                      typename Stepper::isotropy_type> {
 public:
  using Isotropy = typename Stepper::isotropy_type;
  explicit Compensated(typename Stepper::spins_type const& like, Isotropy isotropy = {})
      : Compensated::RungeKutta("Compensated", like, isotropy) {}
};

}  // namespace cayspin
