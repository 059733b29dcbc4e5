// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "kokkos_settings.hpp"
#include "method.hpp"

#include <cayspin/rotation/cayley.hpp>
#include <cayspin/rotation/exponential.hpp>
#include <cayspin/stability.hpp>
#include <cayspin/stepper/compensated.hpp>
#include <cayspin/stepper/energy_projection.hpp>

#include <limits>

namespace cayspin::program {

/// Calls work with the rotation as a type; Family::exponential says whether it may be that one.
template <class Family, class Work>
auto with_rotation(io::Rotation rotation, Work const& work) {
  if constexpr (Family::exponential) {
    if (rotation == io::Rotation::exponential) return work(Exponential{});
  }
  return work(Cayley{});
}

/// The entry of an integrator. Family derives from LieFamily and names the Stepper for a Spins and
/// a Rotation.
template <class Family>
struct Entry {
  using HostSpins = SpinField<double, Kokkos::DefaultHostExecutionSpace::memory_space>;
  using Standard = typename Family::template Stepper<HostSpins, Cayley>;

  static double stable_step(double field_bound, double damping, bool precession,
                            MethodOptions const& options) {
    return with_rotation<Family>(options.rotation, [&]<class Rotation>(Rotation) {
      using Linear = typename Family::template Linear<HostSpins, Rotation>;
      if constexpr (std::is_void_v<Linear>)
        return std::numeric_limits<double>::infinity();
      else
        return largest_stable_step<Linear>(field_bound, damping, precession, options.sigma);
    });
  }

  static std::int64_t work_bytes(Lattice const& lattice, bool by_time_alone, bool twice) {
    return twice ? work_bytes_of<double>(lattice, by_time_alone)
                 : work_bytes_of<float>(lattice, by_time_alone);
  }

  static Summary advance(AnySimulation any, MethodOptions const& options) {
    return std::visit([&](auto* simulation) { return advance_one(*simulation, options); }, any);
  }

  static MethodEntry make(MethodKey const& key) {
    return {key,
            Standard::order,
            Standard::evaluations,
            work_fields(),
            Family::exponential,
            work_bytes,
            stable_step,
            advance};
  }

 private:
  static constexpr int work_fields() {
    if constexpr (requires { Family::work_fields; })
      return Family::work_fields;
    else
      return Standard::work_fields;
  }

  template <class Real>
  static std::int64_t work_bytes_of(Lattice const& lattice, bool by_time_alone) {
    using Stepper = typename Family::template Stepper<SpinField<Real>, Cayley>;
    if constexpr (requires { Stepper::work_bytes(lattice, by_time_alone, 1); })
      return static_cast<std::int64_t>(
          Stepper::work_bytes(lattice, by_time_alone, expected_threads()));
    auto const layout = cayspin::detail::RowLayout::of<Real>(lattice);
    return static_cast<std::int64_t>(work_fields() * layout.allocation(3) * sizeof(Real));
  }

  template <class Simulation>
  static Summary advance_one(Simulation& simulation, MethodOptions const& options) {
    return with_rotation<Family>(options.rotation, [&]<class Rotation>(Rotation) {
      using Stepper = typename Family::template Stepper<typename Simulation::Spins, Rotation>;
      Stepper stepper = Family::template make<Stepper>(simulation.spins, options);
      return integrate(simulation.exec, stepper, Family::generator(simulation.generator),
                       simulation.spins, simulation.times, *simulation.observer);
    });
  }
};

/// What methods on the Lie group have in common: both rotations, a constant sigma, any generator, a
/// bound on dt by the stepper's own stages. (Templates given as StepperOf need names of their own:
/// g++ takes aliases of one name for the same, even out of unnamed namespaces of different files.)
template <template <class, class> class StepperOf>
struct LieFamily {
  static constexpr bool exponential = true;
  template <class Spins, class Rotation>
  using Stepper = StepperOf<Spins, Rotation>;
  template <class Spins, class Rotation>
  using Linear = StepperOf<Spins, Rotation>;

  template <class Stepper, class Spins>
  static Stepper make(Spins const& like, MethodOptions const& options) {
    return Stepper(like, SceneIsotropy{options.sigma});
  }
  template <class Generator>
  static Generator const& generator(Generator const& of_the_scene) {
    return of_the_scene;
  }
};

/// Steppers that are made from the spins alone, in Cayley coordinates or in none.
template <template <class, class> class StepperOf>
struct PlainFamily : LieFamily<StepperOf> {
  static constexpr bool exponential = false;
  template <class Stepper, class Spins>
  static Stepper make(Spins const& like, MethodOptions const&) {
    return Stepper(like);
  }
};

/// No bound on dt is known.
struct Unbounded {
  template <class, class>
  using Linear = void;
};

/// The baselines.
template <template <class> class Method>
struct Baseline {
  template <class Spins, class>
  using Stepper = Method<Spins>;
  using Family = PlainFamily<Stepper>;
};

/// The generator of rigid bodies in place of the scene's.
struct OfRigidBodies {
  template <class Generator>
  static auto generator(Generator const& of_the_scene) {
    return of_the_scene.rigid_bodies();
  }
};

/// A method with compensated sums.
template <class Family>
struct WithCompensation : Family {
  static constexpr bool exponential = false;
  template <class Spins, class Rotation>
  using Stepper = Compensated<typename Family::template Stepper<Spins, Rotation>>;
};

/// The entries of a method without and with compensated sums.
template <class Family>
MethodEntries plain_and_compensated(MethodKey key) {
  MethodKey const other{key.method, key.isotropy, key.tangent, key.rigid_body, true};
  return {Entry<Family>::make(key), Entry<WithCompensation<Family>>::make(other)};
}

inline MethodEntries together(std::initializer_list<MethodEntries> groups) {
  MethodEntries all;
  for (auto const& some : groups) all.insert(all.end(), some.begin(), some.end());
  return all;
}

/// A method whose steps are projected to the energy; the bound on dt is the method's own.
template <template <class, class> class StepperOf>
struct ProjectedToEnergy : PlainFamily<StepperOf> {
  template <class Spins, class Rotation>
  using Stepper = EnergyProjection<StepperOf<Spins, Rotation>>;
  template <class Stepper, class Spins>
  static Stepper make(Spins const& like, MethodOptions const&) {
    return Stepper(like, StepperOf<Spins, Cayley>(like));
  }
};

}  // namespace cayspin::program
