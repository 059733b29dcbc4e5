// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/zero.hpp>
#include <cayspin/rotation/exponential.hpp>
#include <cayspin/stepper/runge_kutta.hpp>
#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stage/update.hpp>

namespace cayspin {

/// Commutator-free method of order 4 with exact exponentials: no inverse tangent, two rotations at
/// the last stage and at the end. Celledoni, Marthinsen and Owren 2003; not in the paper.
template <class Spins, class Isotropy = isotropy::Zero>
class CommutatorFree4
    : public RungeKutta<Spins, tableau::CommutatorFree4, update::LieUncorrected<Exponential>,
                        Isotropy> {
 public:
  explicit CommutatorFree4(Spins const& like, Isotropy isotropy = {})
      : CommutatorFree4::RungeKutta("CommutatorFree4", like, isotropy) {}
};

}  // namespace cayspin
