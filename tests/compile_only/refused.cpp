// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// One mistake for each CAYSPIN_TEST_MISTAKE, or all for -1; the compiler must answer with the
// library's sentences.
#include <cayspin/cayspin.hpp>
#include <cayspin/field/dear.hpp>
#include <cayspin/stepper/multirate.hpp>

#define MISTAKE(number) (CAYSPIN_TEST_MISTAKE == (number) || CAYSPIN_TEST_MISTAKE == -1)

using namespace cayspin;

struct Term {
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    return stencil.center();
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    return dot(stencil.center(), stencil.center());
  }
};

struct NoField {
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    return dot(stencil.center(), stencil.center());
  }
};

struct NoEnergy {
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    return stencil.center();
  }
};

struct FieldIsANumber : Term {
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    return dot(stencil.center(), stencil.center());
  }
};

struct NotAGenerator {};

struct WholeGenerator {
  template <class Stencil>
  KOKKOS_FUNCTION auto operator()(Stencil const& stencil) const {
    return stencil.center();
  }
};

struct WithoutEvaluations {
  using spins_type = SpinField<double, Kokkos::HostSpace>;
  template <class Exec, class Generator>
  void step(Exec const&, Generator const&, spins_type&, double, double) {}
};

struct NoDegree {
  template <class HostSpins>
  void operator()(HostSpins const&, HostSpins const&, double) const {}
};

inline void refused() {
  Kokkos::DefaultHostExecutionSpace const exec;
  using Spins = SpinField<double, Kokkos::HostSpace>;
  [[maybe_unused]] Spins spins("spins", Lattice::chain(3));
  [[maybe_unused]] LieEuler stepper(spins);
  [[maybe_unused]] Times const times{0, 0.1, 1};
  [[maybe_unused]] RigidBody const body = RigidBody::principal(1, 2, 3);
  [[maybe_unused]] auto const with = [&](auto const& term) {
    stepper.step(exec, LandauLifshitz(EffectiveField(term), 0.1), spins, 0, 0.1);
  };
  [[maybe_unused]] LandauLifshitz const spin_chain(EffectiveField(Zeeman{{0, 0, 1}}), 0.1);
  [[maybe_unused]] LandauLifshitz const torque(
      EffectiveField(ZhangLi(Lattice::chain(3), {1, 0, 0})), 0);
  [[maybe_unused]] TimeDependentZeeman const rotating([](double t) {
    return Vec3<double>{t, 0, 1};
  });
#if MISTAKE(0)  // none
  with(Term());
#endif
#if MISTAKE(1)
  with(NoField());
#endif
#if MISTAKE(2)
  with(NoEnergy());
#endif
#if MISTAKE(3)
  with(FieldIsANumber());
#endif
#if MISTAKE(4)
  stepper.step(exec, NotAGenerator(), spins, 0, 0.1);
#endif
#if MISTAKE(5)
  integrate(exec, stepper, body, spins, times, [](Step const&) {});
#endif
#if MISTAKE(6)
  integrate(exec, stepper, body, spins, times,
            [](auto const&, Step const& step, auto const&) { return step.number > 3; });
#endif
#if MISTAKE(7)
  norm_defect(Kokkos::HostSpace(), spins);
#endif
#if MISTAKE(8)
  {
    SpinField<float, Kokkos::HostSpace> other("other", Lattice::chain(3));
    integrate(exec, stepper, body, other, times);
  }
#endif
#if MISTAKE(9)
  { HostField<Spins, NoDegree> const field(Lattice::chain(3), NoDegree()); }
#endif
#if MISTAKE(10)
  { HostField<Spins, Term> const field(Lattice::chain(3), Term()); }
#endif
#if MISTAKE(11)
  {
    TimeDependentZeeman const field([](double t) { return t; });
  }
#endif
#if MISTAKE(12)
  { SpinField<long double, Kokkos::HostSpace> const wide("wide", Lattice::chain(3)); }
#endif
#if MISTAKE(13)
  copy(exec, Kokkos::View<double*, Kokkos::HostSpace>("flat", 9), spins);
#endif
#if MISTAKE(14)
  with(SiteDependentExchange(ScalarField<float, Kokkos::HostSpace>("float", Lattice::chain(3))));
#endif
#if MISTAKE(15)
  {
    ScalarField<double, Kokkos::HostSpace> const occupation("occupation", Lattice::chain(3));
    LayerAveragedSlabDemag<Kokkos::HostSpace> const layers(Lattice::chain(3), 0);
    FieldWithVacancies const field(EffectiveField{layers}, occupation);
  }
#endif
#if MISTAKE(16)
  LieHeun(spins, isotropy::Analytic()).step(exec, body, spins, 0, 0.1);
#endif
#if MISTAKE(17)
  LieHeun(spins, isotropy::Energy()).step(exec, spin_chain, spins, 0, 0.1);
#endif
#if MISTAKE(18)
  Series4(spins).step(exec, LandauLifshitz(EffectiveField(rotating), 0.1), spins, 0, 0.1);
#endif
#if MISTAKE(19)
  LieEuler(spins, isotropy::Analytic())
      .step(exec, LandauLifshitz(EffectiveField(Term()), 0.1), spins, 0, 0.1);
#endif
#if MISTAKE(20)
  FieldExtrapolation3(spins).step(exec, WholeGenerator(), spins, 0, 0.1);
#endif
#if MISTAKE(21)
  RedBlack2(spins).step(exec, orthogonal(spin_chain), spins, 0, 0.1);
#endif
#if MISTAKE(22)
  { EnergyControl const control{LandauLifshitz{EffectiveField{rotating}, 0}, spins}; }
#endif
#if MISTAKE(23)
  {
    SpinField<float, Kokkos::HostSpace> const other("other", Lattice::chain(3));
    with(HostField(other, SlabDemagOnHost({1, 0, 0})));
  }
#endif
#if MISTAKE(24)
  {
    AdaptiveRkmk<Spins, tableau::DormandPrince5> adaptive(spins);
    integrate(exec, adaptive, body, spins, times, Every(10, Normalize{}));
  }
#endif
#if MISTAKE(25)
  {
    AdaptiveRkmk<Spins, tableau::DormandPrince5> adaptive(spins);
    integrate(exec, adaptive, body, spins, times, EnergyControl(body, spins));
  }
#endif
#if MISTAKE(26)
  {
    WithoutEvaluations uncounted;
    integrate(exec, uncounted, body, spins, times);
  }
#endif
#if MISTAKE(27)
  energy(exec, orthogonal(WholeGenerator()), spins);
#endif
#if MISTAKE(28)
  { EnergyControl const control{orthogonal(WholeGenerator()), spins}; }
#endif
#if MISTAKE(29)
  evaluate_field(exec, body, spins, 0, Spins("output", Lattice::chain(3)));
#endif
#if MISTAKE(30)
  largest_rate(exec, Zeeman{{0, 0, 1}}, spins);
#endif
#if MISTAKE(31)
  RungeKutta<Spins, tableau::Heun, update::Stereographic, isotropy::Analytic>("chart", spins)
      .step(exec, body, spins, 0, 0.1);
#endif
#if MISTAKE(32)
  {
    Dear const dear(spins, SlabDemag({1, 0, 0}));
    Multirate multirate(spins, LieAdamsBashforth2<Spins>(spins), dear);
  }
#endif
#if MISTAKE(33)
  with(Dear(spins, Term()));
#endif
#if MISTAKE(34)
  minimize(exec, EffectiveField(Zeeman{{0, 0, 1}}, Slonczewski(1, 0, {0, 0, 1})), spins);
#endif
#if MISTAKE(35)
  { EnergyControl const control{orthogonal(torque), spins}; }
#endif
#if MISTAKE(36)
  EnergyProjection(spins, LieEuler(spins)).step(exec, torque, spins, 0, 0.1);
#endif
}
