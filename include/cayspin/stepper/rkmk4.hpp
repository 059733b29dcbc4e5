// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/energy.hpp>
#include <cayspin/isotropy/zero.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/stepper/runge_kutta.hpp>
#include <cayspin/stepper/tableau.hpp>
#include <cayspin/stage/update.hpp>

namespace cayspin {

/// Runge-Kutta-Munthe-Kaas of order 4, stages corrected:
/// F1 = dt A(m), F2 = D(F1/2), F3 = D(F2/2), F4 = D(F3), D(f) = dcay_f^-1 (dt A(cay(f) m)),
/// m <- cay((F1 + 2 F2 + 2 F3 + F4)/6) m. Lewis and Nigam 2002, Sec. 4.4, with its stages 3 and 4
/// mended.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class Rkmk4 : public RungeKutta<Spins, tableau::Classical4, update::Lie<Rotation>, Isotropy> {
 public:
  explicit Rkmk4(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : Rkmk4::RungeKutta("Rkmk4", like, isotropy) {}
};

/// The same with stages 3 and 4 as the paper prints them; order 3, for reproduction only.
template <class Spins, class Isotropy = isotropy::Zero>
class Rkmk4AsPrinted
    : public RungeKutta<Spins, tableau::Classical4, update::LieAsPrinted<Cayley>, Isotropy> {
 public:
  static constexpr int order = 3;
  explicit Rkmk4AsPrinted(Spins const& like, Isotropy isotropy = {})
      : Rkmk4AsPrinted::RungeKutta("Rkmk4AsPrinted", like, isotropy) {}
};

}  // namespace cayspin
