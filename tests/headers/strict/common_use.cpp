// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Uses the classes whose kernels are compiled for devices, and related functions, in both
// precisions, for the warnings that templates give on use.
#include "../../cuda/kernels.cpp"

#include <cayspin_paper/analytic_sigma.hpp>

#include <vector>

namespace cayspin::test {

/// Takes four steps with each stepper.
template <class Generator, class Spins, class... Steppers>
void run_each(Generator const& generator, Spins& spins, Steppers&&... steppers) {
  (integrate(Exec(), steppers, generator, spins, {.begin = 0, .dt = 0.01, .steps = 4}), ...);
}

template <class Real>
void use_beside_kernels(Lattice const& lattice) {
  using S = SpinField<Real, MemorySpace>;
  S spins("spins", lattice);
  LandauLifshitz const generator(EffectiveField(Exchange(lattice, 1.0), Zeeman{{5, 0, 0}}), 0.0);
  run_each(generator, spins, Rkmk4<S>(spins), LieEuler<S, isotropy::Analytic>(spins),
           LieAdamsBashforth2<S>(spins), CommutatorFree4<S>(spins),
           Rkmk<S, tableau::DormandPrince5>(spins), RedBlack2<S>(spins),
           AdaptiveRkmk<S, tableau::Tsitouras5>(spins),
           AdaptiveProjected<S, tableau::DormandPrince5>(spins),
           AdaptiveStereographic<S, tableau::Tsitouras5>(spins));
  std::vector<Sample> samples;
  Rkmk4 stepper(spins);
  integrate(Exec(), stepper, generator, spins, {.begin = 0, .dt = 0.01, .steps = 4},
            Every(2, Record(generator, samples)), Normalize{}, EnergyControl(spins, generator));
  std::ignore = copy_to_host(spins);
}

template void use_beside_kernels<float>(Lattice const&);
template void use_beside_kernels<double>(Lattice const&);

}  // namespace cayspin::test
