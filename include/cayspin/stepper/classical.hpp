// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/zero.hpp>
#include <cayspin/stepper/runge_kutta.hpp>
#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stage/update.hpp>

// The baselines that spin codes use: Runge-Kutta in space, with the same kernels as the geometric
// methods. Classical*: |m| drifts. Projected*: each step ends by dividing by the length.
namespace cayspin {

template <class Spins, class Tableau, bool Renormalise>
class ClassicalRungeKutta
    : public RungeKutta<Spins, Tableau, update::Classical<Renormalise>, isotropy::Zero> {
 public:
  explicit ClassicalRungeKutta(Spins const& like)
      : ClassicalRungeKutta::RungeKutta(
            std::string(Renormalise ? "Projected" : "Classical") + std::to_string(Tableau::order),
            like) {}
};

template <class Spins>
using ClassicalEuler = ClassicalRungeKutta<Spins, tableau::Euler, false>;
template <class Spins>
using ClassicalHeun = ClassicalRungeKutta<Spins, tableau::Heun, false>;
template <class Spins>
using ClassicalRk4 = ClassicalRungeKutta<Spins, tableau::Classical4, false>;
template <class Spins>
using ProjectedEuler = ClassicalRungeKutta<Spins, tableau::Euler, true>;
template <class Spins>
using ProjectedHeun = ClassicalRungeKutta<Spins, tableau::Heun, true>;
template <class Spins>
using ProjectedRk4 = ClassicalRungeKutta<Spins, tableau::Classical4, true>;

}  // namespace cayspin
