// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "method.hpp"

#include <cayspin/rotation/cayley.hpp>
#include <cayspin/rotation/exponential.hpp>
#include <cayspin/stability.hpp>
#include <cayspin/stepper/runge_kutta_stage.hpp>

namespace cayspin::program {

/// Calls work with the rotation as a type; Family::exponential says whether it may be that one.
template <class Family, class Work>
auto with_rotation(io::Rotation rotation, Work const& work) {
  if constexpr (Family::exponential) {
    if (rotation == io::Rotation::exponential) return work(Exponential{});
  }
  return work(Cayley{});
}

/// The entry of a Runge-Kutta method. Family names the Stepper for a Spins and a Rotation, says
/// whether that may be the exponential, and makes one with a sigma.
template <class Family>
struct RungeKuttaEntry {
  template <class Rotation>
  using Double = typename Family::template Stepper<
      SpinField<double, Kokkos::DefaultHostExecutionSpace::memory_space>, Rotation>;
  using Standard = Double<Cayley>;

  static double stable_step(double field_bound, double damping, bool precession,
                            MethodOptions const& options) {
    return with_rotation<Family>(options.rotation, [&]<class Rotation>(Rotation) {
      return largest_stable_step<Double<Rotation>>(field_bound, damping, precession, options.sigma);
    });
  }

  static Summary advance(AnySimulation any, MethodOptions const& options) {
    return std::visit([&](auto* simulation) { return advance_one(*simulation, options); }, any);
  }

  static MethodEntry make(io::Method method) {
    return {method,      Standard::order, Standard::evaluations, Standard::work_fields,
            stable_step, advance};
  }

 private:
  template <class Simulation>
  static Summary advance_one(Simulation& simulation, MethodOptions const& options) {
    return with_rotation<Family>(options.rotation, [&]<class Rotation>(Rotation) {
      using Stepper = typename Family::template Stepper<typename Simulation::Spins, Rotation>;
      Stepper stepper = Family::template make<Stepper>(simulation.spins, options.sigma);
      return integrate(simulation.exec, stepper, simulation.generator, simulation.spins,
                       simulation.times, *simulation.observer);
    });
  }
};

/// Methods on the Lie group, with a sigma.
struct LieFamily {
  static constexpr bool exponential = true;
  template <class Stepper, class Spins>
  static Stepper make(Spins const& like, double sigma) {
    return Stepper(like, SceneIsotropy{sigma});
  }
};

/// The baselines.
template <template <class> class Method>
struct BaselineFamily {
  static constexpr bool exponential = false;
  template <class Spins, class>
  using Stepper = Method<Spins>;
  template <class Stepper, class Spins>
  static Stepper make(Spins const& like, double) {
    return Stepper(like);
  }
};

}  // namespace cayspin::program
