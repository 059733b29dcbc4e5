// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/isotropy/energy.hpp>
#include <cayspin/isotropy/policies.hpp>
#include <cayspin/rotation/cayley.hpp>
#include <cayspin/rotation/exponential.hpp>
#include <cayspin/stage/update.hpp>
#include <cayspin/stage/update_compensated.hpp>
#include <cayspin/stepper/runge_kutta.hpp>
#include <cayspin/stepper/tableau.hpp>

// The named Runge-Kutta methods with constant steps. Each combines a tableau, an update and an
// isotropy.
namespace cayspin::inline v0_2 {

/// Geometric Euler, order 1: m <- cay(dt * xi) m, xi = A(m) + sigma * m.
/// Lewis and Nigam 2002, Sec. 4.2. <cayspin/stepper/corrected_euler.hpp> adds the isotropies
/// FiniteDifference and FiniteDifferenceBackward, and <cayspin_paper/analytic_sigma.hpp> adds
/// Analytic and Connection.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class LieEuler : public RungeKutta<Spins, tableau::Euler, update::Lie<Rotation>, Isotropy> {
 public:
  explicit LieEuler(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : LieEuler::RungeKutta("LieEuler", like, isotropy) {}
};

/// Geometric Heun, order 2: F = dt * (xi(m) + xi(cay(dt * xi(m)) m)) / 2, m <- cay(F) m,
/// xi = A + sigma * m. Lewis and Nigam 2002, Sec. 4.3.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class LieHeun
    : public RungeKutta<Spins, tableau::Heun, update::LieUncorrected<Rotation>, Isotropy> {
 public:
  explicit LieHeun(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : LieHeun::RungeKutta("LieHeun", like, isotropy) {}
};

/// Runge-Kutta-Munthe-Kaas of order 4:
/// F1 = dt * xi(m), F2 = D(F1/2), F3 = D(F2/2), F4 = D(F3), D(f) = dcay_f^-1 (dt * xi(cay(f) m)),
/// m <- cay((F1 + 2 * F2 + 2 * F3 + F4) / 6) m, xi = A + sigma * m. Lewis and Nigam 2002, Sec. 4.4,
/// with corrections to its stages 3 and 4.
template <class Spins, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class Rkmk4 : public RungeKutta<Spins, tableau::Classical4, update::Lie<Rotation>, Isotropy> {
 public:
  explicit Rkmk4(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : Rkmk4::RungeKutta("Rkmk4", like, isotropy) {}
};

/// Runge-Kutta-Munthe-Kaas with any explicit tableau; the order is that of the tableau. To add a
/// method, write a struct like those in cayspin::tableau. F_i = D(sum_j a_ij * F_j), D(f) =
/// dcay_f^-1 (dt * xi(cay(f) m)), m <- cay(sum_i b_i * F_i) m, xi = A + sigma * m. Lewis and Nigam
/// 2002, Sec. 2.
template <class Spins, class Tableau, class Isotropy = isotropy::Zero, class Rotation = Cayley>
class Rkmk : public RungeKutta<Spins, Tableau, update::Lie<Rotation>, Isotropy> {
 public:
  explicit Rkmk(Spins const& like, Isotropy isotropy = {}, Rotation = {})
      : Rkmk::RungeKutta("Rkmk", like, isotropy) {}
};

/// Runge-Kutta with any explicit tableau in stereographic coordinates. The chart of each spin is
/// centred at its direction at the start of the step, to which all coordinates are orthogonal
/// (update::Stereographic). The order is that of the tableau. The method accepts no sigma.
template <class Spins, class Tableau = tableau::Classical4>
class StereographicRungeKutta
    : public RungeKutta<Spins, Tableau, update::Stereographic, isotropy::Zero> {
 public:
  explicit StereographicRungeKutta(Spins const& like)
      : StereographicRungeKutta::RungeKutta("StereographicRungeKutta", like) {}
};

/// Commutator-free method of order 4 with exact exponentials: no inverse differential; two
/// rotations lead to the last stage, and two to the end of the step. Celledoni, Marthinsen and
/// Owren 2003.
template <class Spins, class Isotropy = isotropy::Zero>
class CommutatorFree4 : public RungeKutta<Spins, tableau::CommutatorFree4,
                                          update::LieUncorrected<Exponential>, Isotropy> {
 public:
  explicit CommutatorFree4(Spins const& like, Isotropy isotropy = {})
      : CommutatorFree4::RungeKutta("CommutatorFree4", like, isotropy) {}
};

/// Baseline: Runge-Kutta in Cartesian components, with the same kernels as the geometric methods.
/// |m| drifts.
template <class Spins, class Tableau>
class ClassicalRungeKutta : public RungeKutta<Spins, Tableau, update::Classical, isotropy::Zero> {
 public:
  explicit ClassicalRungeKutta(Spins const& like)
      : ClassicalRungeKutta::RungeKutta("Classical" + std::to_string(Tableau::order), like) {}
};

/// Baseline used by most spin codes: Runge-Kutta in Cartesian components; at the end of a step,
/// each spin is divided by its length.
template <class Spins, class Tableau>
class ProjectedRungeKutta : public RungeKutta<Spins, Tableau, update::Projected, isotropy::Zero> {
 public:
  explicit ProjectedRungeKutta(Spins const& like)
      : ProjectedRungeKutta::RungeKutta("Projected" + std::to_string(Tableau::order), like) {}
};

// Classes rather than aliases, so that compilers deduce Spins: ProjectedRk4 stepper(spins).

/// Euler's method in Cartesian components, order 1, one evaluation per step. |m| drifts.
template <class Spins>
class ClassicalEuler : public ClassicalRungeKutta<Spins, tableau::Euler> {
 public:
  explicit ClassicalEuler(Spins const& like) : ClassicalEuler::ClassicalRungeKutta(like) {}
};

/// Heun's method in Cartesian components, order 2, two evaluations per step. |m| drifts.
template <class Spins>
class ClassicalHeun : public ClassicalRungeKutta<Spins, tableau::Heun> {
 public:
  explicit ClassicalHeun(Spins const& like) : ClassicalHeun::ClassicalRungeKutta(like) {}
};

/// The classical Runge-Kutta method in Cartesian components, order 4, four evaluations per step.
/// |m| drifts.
template <class Spins>
class ClassicalRk4 : public ClassicalRungeKutta<Spins, tableau::Classical4> {
 public:
  explicit ClassicalRk4(Spins const& like) : ClassicalRk4::ClassicalRungeKutta(like) {}
};

/// Euler's method in Cartesian components, order 1, with each spin divided by its length at the end
/// of a step.
template <class Spins>
class ProjectedEuler : public ProjectedRungeKutta<Spins, tableau::Euler> {
 public:
  explicit ProjectedEuler(Spins const& like) : ProjectedEuler::ProjectedRungeKutta(like) {}
};

/// Heun's method in Cartesian components, order 2, with each spin divided by its length at the end
/// of a step.
template <class Spins>
class ProjectedHeun : public ProjectedRungeKutta<Spins, tableau::Heun> {
 public:
  explicit ProjectedHeun(Spins const& like) : ProjectedHeun::ProjectedRungeKutta(like) {}
};

/// The classical Runge-Kutta method in Cartesian components, order 4, with each spin divided by its
/// length at the end of a step.
template <class Spins>
class ProjectedRk4 : public ProjectedRungeKutta<Spins, tableau::Classical4> {
 public:
  explicit ProjectedRk4(Spins const& like) : ProjectedRk4::ProjectedRungeKutta(like) {}
};

/// A Runge-Kutta method with compensated sums, for example Compensated<Rkmk4<Spins>>. It stores the
/// rounding error of the spins at the end of a step and adds it to the next step (Kahan 1965), so
/// that round-off does not grow with the number of steps. In float, an error of about 1e-6 remains,
/// because fields are evaluated at rounded spins; a step takes up to a third more time
/// (docs/reference/methods.md). The method needs one more field of work memory, and always stores
/// the increments of its stages, which some methods otherwise recompute from spins. Do not compile
/// it with -ffast-math. It remembers the previous step: `spins` must be those at the end of that
/// step. Otherwise call `reset` first.
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

namespace detail {

template <>
struct EnergyCorrection<tableau::Heun, update::LieUncorrected<Cayley>> {
  using type = HeunCorrection;
};
template <>
struct EnergyCorrection<tableau::Classical4, update::Lie<Cayley>> {
  using type = Rkmk4Correction;
};

}  // namespace detail
}  // namespace cayspin::inline v0_2
