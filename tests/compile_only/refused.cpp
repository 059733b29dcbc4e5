// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The mistake with the number CAYSPIN_TEST_MISTAKE; -1: all mistakes, 0: none. The compiler has to
// answer each with a sentence of the library. CMakeLists.txt takes the name of a mistake from the
// line of its #if, and the sentence, a regular expression, from the next line.
#include <cayspin/cayspin.hpp>
#include <cayspin/field/field_of_moments.hpp>
#include <cayspin/field/slow_field.hpp>
#include <cayspin/observer/thermal_noise.hpp>
#include <cayspin/stepper/multirate.hpp>

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/series4.hpp>

#define MISTAKE(number) (CAYSPIN_TEST_MISTAKE == (number) || CAYSPIN_TEST_MISTAKE == -1)

using namespace cayspin;

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

struct Term : NoEnergy, NoField {};

struct FieldIsANumber : Term {
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    return dot(stencil.center(), stencil.center());
  }
};

struct LoadsDoubles : NoField {
  SiteArray<double, 3> field_of_sites;
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    return stencil.site().load(field_of_sites);
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

/// An observer that changes when it is asked whether it is due. Number: makes types differ, since
/// each type is refused once.
template <int Number>
struct CountsQuestions {
  int questions = 0;
  bool due(Step const&) { return ++questions > 3; }
  template <class Exec>
  void operator()(Exec const&, Step const&, WithoutEvaluations::spins_type const&) {}
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
#if MISTAKE(1)  // term_without_field
  // A field term needs a const, device-callable template field
  with(NoField());
#endif
#if MISTAKE(2)  // term_without_energy
  // A field term needs a const, device-callable template energy_density
  with(NoEnergy());
#endif
#if MISTAKE(3)  // term_of_wrong_type
  // A field term needs a const, device-callable template field
  with(FieldIsANumber());
#endif
#if MISTAKE(4)  // not_a_generator
  // A generator needs a const, device-callable template operator...stencil.
  stepper.step(exec, NotAGenerator(), spins, 0, 0.1);
#endif
#if MISTAKE(5)  // observer_of_wrong_arguments
  // An observer is called as observer.exec, Step, spins.
  integrate(exec, stepper, body, spins, times, [](Step const&) {});
#endif
#if MISTAKE(6)  // observer_of_wrong_result
  // An observer returns nothing, or cayspin::Next to say whether to go on
  integrate(exec, stepper, body, spins, times,
            [](auto const&, Step const& step, auto const&) { return step.number > 3; });
#endif
#if MISTAKE(7)  // not_an_execution_space
  // The first argument of a cayspin function is a Kokkos execution space instance
  norm_defect(Kokkos::HostSpace(), spins);
#endif
#if MISTAKE(8)  // stepper_of_other_spins
  // The stepper was made for another type of spin field
  {
    SpinField<float, Kokkos::HostSpace> other("other", Lattice::chain(3));
    integrate(exec, stepper, body, other, times);
  }
#endif
#if MISTAKE(9)  // host_field_without_degree
  // HostField's solver needs a static constexpr int degree
  { HostField<Spins, NoDegree> const field(Lattice::chain(3), NoDegree()); }
#endif
#if MISTAKE(10)  // host_field_not_callable
  // HostField needs a solver callable as solver
  { HostField<Spins, Term> const field(Lattice::chain(3), Term()); }
#endif
#if MISTAKE(11)  // time_dependent_number
  // TimeDependentZeeman takes a callable Vec3<double>
  {
    TimeDependentZeeman const field([](double t) { return t; });
  }
#endif
#if MISTAKE(12)  // long_double
  // cayspin fields hold float or double
  { SpinField<long double, Kokkos::HostSpace> const wide("wide", Lattice::chain(3)); }
#endif
#if MISTAKE(13)  // flat_view
  // cayspin::copy takes a View of rank 2
  copy(exec, Kokkos::View<double*, Kokkos::HostSpace>("flat", 9), spins);
#endif
#if MISTAKE(14)  // coefficient_of_other_precision
  // A field of coefficients has the precision and the memory space of the spins
  with(SiteDependentExchange(ScalarField<float, Kokkos::HostSpace>("float", Lattice::chain(3))));
#endif
#if MISTAKE(15)  // couplings_with_vacancies
  // PairCouplings read the spins of vacant sites
  {
    ScalarField<double, Kokkos::HostSpace> const occupation("occupation", Lattice::chain(3));
    PairCouplings<Kokkos::HostSpace> const couplings(Lattice::chain(3), {});
    FieldWithVacancies const field(EffectiveField{couplings}, occupation);
  }
#endif
#if MISTAKE(16)  // analytic_sigma_for_heun
  // This isotropy policy does not go with this stepper: Zero and Constant go with all
  LieHeun(spins, isotropy::Analytic()).step(exec, body, spins, 0, 0.1);
#endif
#if MISTAKE(17)  // energy_correction_of_spins
  // isotropy::Energy is for rigid bodies only
  LieHeun(spins, isotropy::Energy()).step(exec, spin_chain, spins, 0, 0.1);
#endif
#if MISTAKE(18)  // series_of_changing_field
  // Series4 refuses fields that depend on t
  Series4(spins).step(exec, LandauLifshitz(EffectiveField(rotating), 0.1), spins, 0, 0.1);
#endif
#if MISTAKE(19)  // term_without_derivative
  // This needs the derivative of each field term
  LieEuler(spins, isotropy::Analytic())
      .step(exec, LandauLifshitz(EffectiveField(Term()), 0.1), spins, 0, 0.1);
#endif
#if MISTAKE(21)  // red_black_of_another_equation
  // RedBlack moves spins by the Landau-Lifshitz equation: its generator is a
  RedBlack2(spins).step(exec, orthogonal(spin_chain), spins, 0, 0.1);
#endif
#if MISTAKE(51)  // steps_of_const_spins
  // integrate takes spins that are not const
  {
    Spins const start("start", Lattice::chain(3));
    integrate(exec, stepper, body, start, times);
  }
#endif
#if MISTAKE(52)  // minimum_of_const_spins
  // minimize takes spins that are not const
  {
    Spins const start("start", Lattice::chain(3));
    minimize(exec, Zeeman{{0, 0, 1}}, start);
  }
#endif
#if MISTAKE(50)  // term_that_loads_another_precision
  // A field that a term loads has the precision of the spins
  {
    SpinField<float, Kokkos::HostSpace> const few("few", Lattice::chain(3));
    SpinField<float, Kokkos::HostSpace> const output("output", Lattice::chain(3));
    evaluate_field(exec, LoadsDoubles(), few, 0, output);
  }
#endif
#if MISTAKE(49)  // red_black_of_pair_couplings
  // RedBlack takes couplings between nearest neighbours along the axes only
  {
    PairCouplings<Kokkos::HostSpace> const couplings(Lattice::chain(3), {});
    LandauLifshitz const generator(EffectiveField(Zeeman{{0, 0, 1}}, couplings), 0.1);
    RedBlack2(spins).step(exec, generator, spins, 0, 0.1);
  }
#endif
#if MISTAKE(22)  // energy_control_of_changing_field
  // EnergyControl refuses fields that depend on t
  { EnergyControl const control{spins, LandauLifshitz{EffectiveField{rotating}, 0}}; }
#endif
#if MISTAKE(23)  // host_field_of_other_precision
  // HostField was made for spins of another precision or memory space
  {
    SpinField<float, Kokkos::HostSpace> const other("other", Lattice::chain(3));
    with(HostField(other, SlabDemagOnHost({1, 0, 0})));
  }
#endif
#if MISTAKE(24)  // normalize_with_adaptive_steps
  // An observer that changes spins .EnergyControl, Normalize. does not go with an
  {
    AdaptiveRkmk<Spins, tableau::DormandPrince5> adaptive(spins);
    integrate(exec, adaptive, body, spins, times, Every(10, Normalize{}));
  }
#endif
#if MISTAKE(25)  // energy_control_with_adaptive_steps
  // An observer that changes spins .EnergyControl, Normalize. does not go with an
  {
    AdaptiveRkmk<Spins, tableau::DormandPrince5> adaptive(spins);
    integrate(exec, adaptive, body, spins, times, EnergyControl(spins, body));
  }
#endif
#if MISTAKE(26)  // stepper_that_counts_nothing
  // A stepper needs step.exec, generator, spins, t, dt.
  {
    WithoutEvaluations uncounted;
    integrate(exec, uncounted, body, spins, times);
  }
#endif
#if MISTAKE(27)  // energy_of_a_generator_without
  // An energy is that of an EffectiveField, a field term
  energy(exec, orthogonal(WholeGenerator()), spins);
#endif
#if MISTAKE(28)  // energy_control_of_any_generator
  // EnergyControl needs a generator that says whether it conserves its energy
  { EnergyControl const control{spins, orthogonal(WholeGenerator())}; }
#endif
#if MISTAKE(29)  // field_of_a_generator
  // A field term needs a const, device-callable template field
  evaluate_field(exec, body, spins, 0, Spins("output", Lattice::chain(3)));
#endif
#if MISTAKE(30)  // rate_of_a_field
  // A generator needs a const, device-callable template operator
  largest_rate(exec, Zeeman{{0, 0, 1}}, spins);
#endif
#if MISTAKE(31)  // analytic_sigma_in_the_chart
  // This isotropy policy does not go with this stepper: Zero and Constant go with all
  RungeKutta<Spins, tableau::Heun, update::Stereographic, isotropy::Analytic>("chart", spins)
      .step(exec, body, spins, 0, 0.1);
#endif
#if MISTAKE(32)  // multistep_between_slow_fields
  // Multirate needs a method that remembers no steps
  {
    SlowField const slow(spins, SlabDemag({1, 0, 0}));
    Multirate multirate(spins, LieAdamsBashforth2<Spins>(spins), slow);
  }
#endif
#if MISTAKE(33)  // slow_term_of_unknown_degree
  // SlowField needs a term with a static constexpr int degree
  with(SlowField(spins, Term()));
#endif
#if MISTAKE(34)  // minimum_under_a_torque
  // This needs a field that is the derivative of an energy, without terms that
  minimize(exec,
           EffectiveField(Zeeman{{0, 0, 1}},
                          Slonczewski({.damping_like = 1, .polarization = {0, 0, 1}})),
           spins);
#endif
#if MISTAKE(35)  // energy_control_under_a_torque
  // This needs a field that is the derivative of an energy, without terms that
  { EnergyControl const control{spins, orthogonal(torque)}; }
#endif
#if MISTAKE(37)  // couplings_of_moments_with_vacancies
  // PairCouplings read the spins of vacant sites
  {
    ScalarField<double, Kokkos::HostSpace> const occupation("occupation", Lattice::chain(3));
    PairCouplings<Kokkos::HostSpace> const couplings(Lattice::chain(3), {});
    FieldOfMoments const of_moments(couplings, CellMoments(Lattice::chain(3), {1}));
    FieldWithVacancies const field(of_moments, occupation);
  }
#endif
#if MISTAKE(38)  // slow_couplings_with_vacancies
  // PairCouplings read the spins of vacant sites
  {
    ScalarField<double, Kokkos::HostSpace> const occupation("occupation", Lattice::chain(3));
    PairCouplings<Kokkos::HostSpace> const couplings(Lattice::chain(3), {});
    FieldWithVacancies const field(EffectiveField(SlowField(spins, couplings)), occupation);
  }
#endif
#if MISTAKE(44)  // slow_exchange_with_vacancies
  // SlowField evaluates its term for the spins of vacant sites, too
  {
    ScalarField<double, Kokkos::HostSpace> const occupation("occupation", Lattice::chain(3));
    FieldWithVacancies const field(SlowField(spins, Exchange(Lattice::chain(3), 1)), occupation);
  }
#endif
#if MISTAKE(41)  // stop_after_the_noise_of_the_next_step
  // ThermalNoise's before_steps.. and between_steps.. come after every observer
  {
    LieEuler stepper(spins);
    ThermalNoise const noise(spins, 0.1, {.temperature = 1});
    integrate(exec, stepper, spin_chain, spins, times, noise.before_steps(),
              [](auto const&, Step const&, auto const&) { return Next::stop; });
  }
#endif
#if MISTAKE(42)  // energy_control_of_moments
  // This needs a field that is the derivative of an energy, without terms that
  {
    FieldOfMoments const of_moments(Exchange(Lattice::chain(3), 1),
                                    CellMoments(Lattice::chain(3), {2}));
    EnergyControl const control{spins, LandauLifshitz(of_moments, 0)};
  }
#endif
#if MISTAKE(43)  // energy_control_by_reference_with_adaptive_steps
  // An observer that changes spins .EnergyControl, Normalize. does not go with an
  {
    AdaptiveRkmk<Spins, tableau::DormandPrince5> adaptive(spins);
    EnergyControl control(spins, body);
    integrate(exec, adaptive, body, spins, times, Every(10, std::ref(control)));
  }
#endif
#if MISTAKE(45)  // due_that_changes_the_observer
  // An observer's due.Step. must be const
  integrate(exec, stepper, body, spins, times, CountsQuestions<1>());
#endif
#if MISTAKE(46)  // due_within_every_that_changes_the_observer
  // An observer's due.Step. must be const
  integrate(exec, stepper, body, spins, times, Every(10, CountsQuestions<2>()));
#endif
#if MISTAKE(47)  // stop_after_the_noise_within_every
  // ThermalNoise's before_steps.. and between_steps.. come after every observer
  {
    ThermalNoise const noise(spins, 0.1, {.temperature = 1});
    integrate(exec, stepper, spin_chain, spins, times, Every(1, noise.before_steps()),
              [](auto const&, Step const&, auto const&) { return Next::stop; });
  }
#endif
#if MISTAKE(48)  // stop_after_the_noise_by_reference
  // ThermalNoise's before_steps.. and between_steps.. come after every observer
  {
    ThermalNoise const noise(spins, 0.1, {.temperature = 1});
    auto const before = noise.before_steps();
    integrate(exec, stepper, spin_chain, spins, times, std::ref(before),
              [](auto const&, Step const&, auto const&) { return Next::stop; });
  }
#endif
}
