// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The common classes in both precisions, for the warnings that templates give when they are used.
#include <cayspin/cayspin.hpp>

#include <tuple>
#include <vector>

namespace {

using Exec = Kokkos::DefaultHostExecutionSpace;

template <class Real>
using Field = cayspin::SpinField<Real, Exec::memory_space>;

template <class Generator, class Spins, class... Steppers>
void use_all(Generator const& generator, Spins& spins, Steppers&&... steppers) {
  cayspin::Times const times{.begin = 0, .dt = 0.01, .steps = 4};
  (cayspin::integrate(Exec(), steppers, generator, spins, times), ...);
}

template <class Real>
void use_generators(cayspin::Lattice const& lattice) {
  Field<Real> spins("spins", lattice);
  cayspin::EffectiveField const field(
      cayspin::Exchange(lattice, 1.0), cayspin::UniaxialAnisotropy(1.0, {0, 0, 1}),
      cayspin::SlabDemag({1, 0, 0}), cayspin::LayerAveragedSlabDemag(lattice, 2),
      cayspin::Zeeman{{5, 0, 0}});
  cayspin::Rkmk4 stepper(spins);
  use_all(cayspin::LandauLifshitz(field, 0.05), spins, stepper);
  use_all(cayspin::Orthogonal(cayspin::LandauLifshitz(field, 0.05)), spins, stepper);
  use_all(cayspin::RigidBody::principal(1.0, 2.0, 3.0), spins, stepper);

  cayspin::ScalarField<Real, Exec::memory_space> const numbers("numbers", lattice);
  cayspin::SiteDependentExchange const exchange(numbers);
  cayspin::SiteDependentUniaxialAnisotropy const anisotropy(0.5, spins);
  cayspin::EffectiveField const of_sites(exchange, anisotropy);
  cayspin::FieldWithVacancies const among_vacancies(of_sites, numbers);
  use_all(cayspin::LandauLifshitz(among_vacancies, numbers), spins, stepper);
}

template <class Real>
void use_steppers(cayspin::Lattice const& lattice) {
  using Spins = Field<Real>;
  Spins spins("spins", lattice);
  cayspin::LandauLifshitz const generator(
      cayspin::EffectiveField(cayspin::Exchange(lattice, 1.0), cayspin::Zeeman{{5, 0, 0}}), 0.0);
  namespace isotropy = cayspin::isotropy;
  namespace tableau = cayspin::tableau;
  use_all(generator, spins, cayspin::LieEuler<Spins>(spins),
          cayspin::LieEuler<Spins, isotropy::FiniteDifference>(spins),
          cayspin::LieEuler<Spins, isotropy::Analytic>(spins), cayspin::LieHeun<Spins>(spins),
          cayspin::LieAdamsBashforth2<Spins>(spins), cayspin::CommutatorFree4<Spins>(spins),
          cayspin::Rkmk4<Spins, isotropy::Zero, cayspin::Exponential>(spins),
          cayspin::Rkmk<Spins, tableau::DormandPrince5>(spins),
          cayspin::StereographicRungeKutta<Spins, tableau::Classical4>(spins),
          cayspin::ClassicalEuler<Spins>(spins), cayspin::ProjectedRk4<Spins>(spins),
          cayspin::Compensated<cayspin::Rkmk4<Spins>>(spins), cayspin::Series4<Spins>(spins),
          cayspin::ImplicitMidpoint<Spins>(spins), cayspin::RedBlack2<Spins>(spins),
          cayspin::FieldExtrapolation4<Spins>(spins),
          cayspin::EnergyProjection<cayspin::LieHeun<Spins>>(spins, cayspin::LieHeun(spins)),
          cayspin::AdaptiveRkmk<Spins, tableau::Tsitouras5>(spins),
          cayspin::AdaptiveProjected<Spins, tableau::DormandPrince5>(spins),
          cayspin::AdaptiveStereographic<Spins, tableau::Tsitouras5>(spins));
}

template <class Real>
void use_observers(cayspin::Lattice const& lattice) {
  Field<Real> spins("spins", lattice);
  cayspin::LandauLifshitz const generator(cayspin::EffectiveField(cayspin::Exchange(lattice, 1.0)),
                                          0.0);
  std::vector<cayspin::Sample> samples;
  cayspin::Rkmk4 stepper(spins);
  cayspin::integrate(Exec(), stepper, generator, spins, {.begin = 0, .dt = 0.01, .steps = 4},
                     cayspin::Every(2, cayspin::Record(generator, samples)), cayspin::Normalize{},
                     cayspin::EnergyControl(generator, spins));
  std::ignore = cayspin::magnetization(Exec(), spins);
  std::ignore = cayspin::norm_defect(Exec(), spins);
  std::ignore = cayspin::copy_to_host(spins);
}

}  // namespace

int main(int argc, char** argv) {
  Kokkos::ScopeGuard const kokkos(argc, argv);
  auto const slab = cayspin::Lattice::cubic(4, 4, 4);
  use_generators<double>(slab);
  use_generators<float>(slab);
  use_steppers<double>(slab);
  use_steppers<float>(slab);
  use_observers<double>(slab);
  use_observers<float>(slab);
}
