// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/zero.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stepper/runge_kutta.hpp>
#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stage/update.hpp>

namespace cayspin {

/// Runge-Kutta-Munthe-Kaas with any explicit tableau, of the tableau's order: a new method is a
/// struct like those in cayspin::tableau.
/// F_i = D(sum_j a_ij F_j), D(f) = dcay_f^-1 (dt xi(cay(f) m)), m <- cay(sum_i b_i F_i) m.
/// Lewis and Nigam 2002, Sec. 2.
template <class Spins, class Tableau, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class Rkmk : public RungeKutta<Spins, Tableau, update::Lie<Rotation>, Isotropy> {
 public:
  explicit Rkmk(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : Rkmk::RungeKutta("Rkmk", like, isotropy) {}
};

/// The same tableaux in the stereographic chart at each step's first spin, all coordinates
/// orthogonal to it (update::Stereographic). Order of the tableau; has no sigma of its own.
template <class Spins, class Tableau>
class StereographicRungeKutta
    : public RungeKutta<Spins, Tableau, update::Stereographic, isotropy::Zero> {
 public:
  explicit StereographicRungeKutta(Spins const& like)
      : StereographicRungeKutta::RungeKutta("StereographicRungeKutta", like) {}
};

}  // namespace cayspin
