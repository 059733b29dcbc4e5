// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Kernels of steppers, isotropy policies, generators, field terms and scalars, compiled in both
// precisions for the device that Kokkos is configured for. Nothing is run.
#include <cayspin/cayspin.hpp>

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/rkmk4_as_printed.hpp>
#include <cayspin_paper/series4.hpp>

#include <tuple>

namespace cayspin::test {

using Exec = Kokkos::DefaultExecutionSpace;
using MemorySpace = Exec::memory_space;

/// Takes a step with each stepper.
template <class Generator, class Spins, class... Steppers>
void step_each(Generator const& generator, Spins& spins, std::tuple<Steppers...>& steppers) {
  std::apply([&](auto&... stepper) { (stepper.step(Exec(), generator, spins, 0, 0.1), ...); },
             steppers);
}

/// Takes steps in one launch.
template <class Generator, class Spins, class... Steppers>
void batch_each(Generator const& generator, Spins& spins, Steppers&... steppers) {
  (steppers.batch(Exec(), generator, spins, 0, 0.1, 3), ...);
}

template <class Real>
struct Steppers {
  using S = SpinField<Real, MemorySpace>;
  using Field = EffectiveField<Exchange, UniaxialAnisotropy, Zeeman>;

  std::tuple<
      LieEuler<S>, LieEuler<S, isotropy::Constant>, LieEuler<S, isotropy::Analytic>,
      LieEuler<S, isotropy::Connection>, LieEuler<S, isotropy::FiniteDifference>,
      LieEuler<S, isotropy::FiniteDifferenceBackward>, LieEuler<S, isotropy::Zero, Exponential>,
      LieEuler<S, isotropy::Zero, OverflowSafeCayley>, LieHeun<S>, LieAdamsBashforth2<S>,
      Rkmk<S, tableau::Kutta3>, Rkmk4<S>, Compensated<Rkmk4<S>>,
      Rkmk4<S, isotropy::Zero, Exponential>, Rkmk4AsPrinted<S>,
      StereographicRungeKutta<S, tableau::Heun>, StereographicRungeKutta<S, tableau::Classical4>,
      Series4<S>, Series4Paper<S>, ImplicitLieEuler<S>, ImplicitLieEuler<S, isotropy::Analytic>,
      ImplicitMidpoint<S>, ClassicalEuler<S>, ClassicalHeun<S>, ClassicalRk4<S>, ProjectedEuler<S>,
      ProjectedHeun<S>, ProjectedRk4<S>, ProjectedRungeKutta<S, tableau::Oscillatory74>,
      RedBlack2<S>, StiffGauss2<S>, StiffGauss4<S>>
      of_spins;
  std::tuple<LieHeun<S, isotropy::Energy>, Rkmk4<S, isotropy::Energy>, Series4<S, isotropy::Energy>,
             Series4Paper<S, isotropy::Energy>>
      of_bodies;

  void step(LandauLifshitz<Field> const& generator, RigidBody const& body, S& spins) {
    step_each(generator, spins, of_spins);
    step_each(body, spins, of_bodies);
    batch_each(generator, spins, std::get<LieEuler<S>>(of_spins), std::get<LieHeun<S>>(of_spins),
               std::get<Rkmk4<S>>(of_spins), std::get<Compensated<Rkmk4<S>>>(of_spins),
               std::get<StereographicRungeKutta<S, tableau::Classical4>>(of_spins));
    batch_each(body, spins, std::get<Rkmk4<S, isotropy::Energy>>(of_bodies));
    EnergyControl(spins, generator)(Exec(), Step{}, spins);
    EnergyControl(spins, body)(Exec(), Step{}, spins);
  }
};

template struct Steppers<float>;
template struct Steppers<double>;

template <class Real>
struct Generators {
  using S = SpinField<Real, MemorySpace>;
  using Numbers = ScalarField<Real, MemorySpace>;
  using Vectors = SiteField<Real, 3, MemorySpace>;
  using Slab = EffectiveField<Exchange, UniaxialAnisotropy, SlabDemag, Zeeman>;
  using PerSite = EffectiveField<SiteDependentExchange<Real, MemorySpace>,
                                 SiteDependentUniaxialAnisotropy<Numbers, Vectors>>;
  using Prepared =
      EffectiveField<TimeDependentZeeman<Vec3<double> (*)(double)>, HostField<S, SlabDemagOnHost>>;
  using SlowTerm = SlowField<S, HostField<S, SlabDemagOnHost>>;
  using WithSlow = EffectiveField<Exchange, SlowTerm>;

  std::tuple<LandauLifshitz<Slab>, Orthogonal<LandauLifshitz<Slab>>,
             LandauLifshitz<PerSite, Numbers>, LandauLifshitz<Prepared>,
             LandauLifshitz<FieldWithVacancies<Slab, Real, MemorySpace>>, RigidBody,
             RigidBodyEnsemble<Real, MemorySpace>>
      generators;

  void use(Multirate<Rkmk4<S>, SlowTerm>& stepper, LandauLifshitz<WithSlow> const& generator,
           S& spins) const {
    stepper.step(Exec(), generator, spins, 0, 0.1);
  }
  double use(LieEuler<S>& stepper, S& spins, Numbers const& weights) const {
    auto const one = [&](auto const& generator) {
      stepper.step(Exec(), generator, spins, 0, 0.1);
      stepper.batch(Exec(), generator, spins, 0, 0.1, 3);
      return energy(Exec(), generator, spins).value + largest_rate(Exec(), generator, spins);
    };
    minimize(Exec(), std::get<0>(generators).field(), spins);
    using Half = typename ThermalNoise<S>::Half;
    ThermalNoise<S>(spins, 0.1, {.temperature = 1}).turn(Exec(), 1, Half::before, 0.1, spins);
    return std::apply([&](auto const&... generator) { return (one(generator) + ...); },
                      generators) +
           norm_defect(Exec(), spins) + magnetization(Exec(), spins).x +
           magnetization(Exec(), spins, weights).x;
  }
};

template struct Generators<float>;
template struct Generators<double>;

}  // namespace cayspin::test
