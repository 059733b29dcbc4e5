// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The library's own types satisfy its contracts, and the contracts distinguish right from wrong.
// Compiled, not run.
#include <cayspin/cayspin.hpp>

#include <cayspin_paper/series4.hpp>

#include <functional>
#include <type_traits>
#include <utility>

namespace cayspin::test {
namespace {

template <class Real>
using Spins = SpinField<Real, Kokkos::HostSpace>;
template <class Real>
using Scalars = ScalarField<Real, Kokkos::HostSpace>;

struct Rotating {
  Vec3<double> operator()(double t) const { return {t, 0, 1}; }
};
struct OnlyAField {
  template <class Stencil>
  auto field(Stencil const& stencil) const {
    return stencil.center();
  }
};

template <class Real, class... Terms>
inline constexpr bool are_terms = (FieldTerm<Terms, Spins<Real>> && ...);

template <class Real>
inline constexpr bool terms_of_cayspin =
    are_terms<Real, Exchange, UniaxialAnisotropy, Zeeman, TimeDependentZeeman<Rotating>, SlabDemag,
              CubicAnisotropy, InterfacialDmi, BulkDmi, ZhangLi, Slonczewski,
              PairCouplings<Kokkos::HostSpace>, HostField<Spins<Real>, SlabDemagOnHost>,
              SiteDependentExchange<Real, Kokkos::HostSpace>,
              SiteDependentUniaxialAnisotropy<Scalars<Real>, Vec3<double>>, EffectiveField<>,
              EffectiveField<Exchange, Zeeman>,
              FieldWithVacancies<EffectiveField<Exchange>, Real, Kokkos::HostSpace>>;
static_assert(terms_of_cayspin<float> && terms_of_cayspin<double>);
static_assert(!FieldTerm<OnlyAField> && !FieldTerm<RigidBody> && !FieldTerm<int>);

template <class Real>
using Llg = LandauLifshitz<EffectiveField<Exchange, TimeDependentZeeman<Rotating>>, Scalars<Real>>;
template <class Real>
inline constexpr bool generators_of_cayspin =
    Generator<Llg<Real>, Spins<Real>> && Generator<Orthogonal<Llg<Real>>, Spins<Real>> &&
    Generator<RigidBody, Spins<Real>> &&
    Generator<RigidBodyEnsemble<Real, Kokkos::HostSpace>, Spins<Real>>;
static_assert(generators_of_cayspin<float> && generators_of_cayspin<double>);
static_assert(!Generator<EffectiveField<Zeeman>> && !Generator<int>);

// Optional members are forwarded by wrappers.
static_assert(detail::depends_on_time<Orthogonal<Llg<double>>>);
static_assert(!detail::depends_on_time<LandauLifshitz<EffectiveField<Exchange>>>);
static_assert(detail::is_local<EffectiveField<Zeeman, UniaxialAnisotropy>>);
static_assert(!detail::is_local<EffectiveField<Zeeman, Exchange>>);
static_assert(!detail::SeriesOf<LandauLifshitz<EffectiveField<Zeeman>>>::is_local);
static_assert(detail::SeriesOf<Orthogonal<RigidBody>>::is_local);
static_assert(detail::energy_terms<Orthogonal<Llg<double>>> == 2);

// LandauLifshitz takes its precession only as a bool.
using Applied = EffectiveField<Zeeman>;
static_assert(std::is_constructible_v<LandauLifshitz<Applied>, Applied, double, bool> &&
              !std::is_constructible_v<LandauLifshitz<Applied>, Applied, double, double>);

using WithTorque = EffectiveField<Exchange, Slonczewski>;
template <class Field>
using WithVacancies = FieldWithVacancies<Field, double, Kokkos::HostSpace>;
static_assert(detail::is_conservative<WithVacancies<EffectiveField<Exchange, Zeeman>>> &&
              detail::is_conservative<EffectiveField<>> && detail::is_conservative<RigidBody> &&
              detail::is_conservative<Orthogonal<Orthogonal<Llg<double>>>>);
static_assert(!detail::is_conservative<ZhangLi> &&
              !detail::is_conservative<WithVacancies<WithTorque>> &&
              !detail::is_conservative<EffectiveField<Zeeman, WithVacancies<WithTorque>>> &&
              !detail::is_conservative<Orthogonal<LandauLifshitz<WithTorque>>>);

using F64 = Spins<double>;
using Adaptive = AdaptiveRkmk<F64, tableau::DormandPrince5>;
static_assert(Stepper<Rkmk4<F64>> && Stepper<LieEuler<F64>> && Stepper<LieHeun<F64>> &&
              Stepper<RedBlack4<F64>> && Stepper<LieAdamsBashforth2<F64>> &&
              Stepper<Series4<F64>> && Stepper<ImplicitMidpoint<F64>> && Stepper<Adaptive>);
static_assert(AdaptiveStepper<Adaptive> && !AdaptiveStepper<ImplicitMidpoint<F64>> &&
              !AdaptiveStepper<Rkmk4<F64>>);
static_assert(!Stepper<F64> && !Stepper<int>);
static_assert(evaluations_per_step<Rkmk4<F64>>() == 4 && evaluations_per_step<LieHeun<F64>>() == 2);
static_assert(!evaluations_per_step<ImplicitMidpoint<F64>>() && !evaluations_per_step<Adaptive>());

// Options that follow numbers have to be named: a bare bool or number is refused.
template <class Options>
concept OptionsOfStableStep =
    requires(Options options) { largest_stable_step<Rkmk4<F64>>(1.0, 0.1, options); };
static_assert(OptionsOfStableStep<StabilityOptions> && !OptionsOfStableStep<bool> &&
              !OptionsOfStableStep<double>);

using Control = EnergyControl<F64, LandauLifshitz<EffectiveField<Exchange>>>;
static_assert(Observer<Record<Zeeman>> && Observer<Normalize> && Observer<Every<Normalize>> &&
              Observer<Control>);
static_assert(!Observer<Zeeman> && !Observer<int>);
static_assert(detail::changes_spins<Every<Every<Normalize>>> && detail::changes_spins<Control> &&
              !detail::changes_spins<Every<Record<Zeeman>>>);
using NoiseBefore = decltype(std::declval<ThermalNoise<F64> const&>().before_steps());
static_assert(detail::begins_step<NoiseBefore> && detail::begins_step<Every<NoiseBefore>> &&
              detail::begins_step<Every<NoiseBefore const&>> &&
              detail::begins_step<std::reference_wrapper<NoiseBefore const>> &&
              !detail::begins_step<Every<Normalize>>);

// The template arguments of HostField are deduced from the solver and from spins or a lattice.
using OnHost = SlabDemagOnHost;
static_assert(std::is_same_v<decltype(HostField(std::declval<Spins<float>>(), OnHost({0, 0, 1}))),
                             HostField<Spins<float>, OnHost>>);
static_assert(std::is_same_v<decltype(HostField(Lattice(), OnHost({0, 0, 1}))),
                             HostField<SpinField<double>, OnHost>>);
// So are those of SlowField.
static_assert(
    std::is_same_v<decltype(SlowField(std::declval<Spins<float>>(), SlabDemag({0, 0, 1}))),
                   SlowField<Spins<float>, SlabDemag>>);
static_assert(std::is_same_v<decltype(SlowField(Lattice(), SlabDemag({0, 0, 1}))),
                             SlowField<SpinField<double>, SlabDemag>>);

/// Multiplies vectors of any value type by numbers of any type, and calls next and previous without
/// the keyword `template`.
struct Operators {
  template <class Stencil>
  KOKKOS_FUNCTION auto field(Stencil const& stencil) const {
    using Value = typename Stencil::value_type;
    auto h = 2.0 * stencil.center() + stencil.center() * 2 + 0.5f * stencil.center();
    h += -next<0>(stencil) * Value(3);
    h -= cayspin::previous<2>(stencil, zero<Value>());
    return select<Value>(Value(0) < h.z, h, zero<Value>());
  }
  template <class Stencil>
  KOKKOS_FUNCTION auto energy_density(Stencil const& stencil) const {
    return dot(stencil.center(), field(stencil));
  }
};
static_assert(FieldTerm<Operators, Spins<float>> && FieldTerm<Operators, Spins<double>>);

}  // namespace
}  // namespace cayspin::test
