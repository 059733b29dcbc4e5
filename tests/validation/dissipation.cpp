// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// With damping the energy falls in every step, for steps up to almost the a-priori limit.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr int steps = 2000;

Slab block(double damping) {
  return {.lattice = Lattice::cubic(6, 6, 6, 0.5),
          .exchange = 0.7,
          .anisotropy = 0.6,
          .axis = {0, 0.6, 0.8},
          .applied = {0.3, 0.1, 0.4},
          .damping = damping};
}

template <class Stepper, class Generator>
void expect_no_rise(char const* method, Generator const& generator, Slab const& slab) {
  Space const exec;
  Spins const start = random_spins(slab.lattice, 7);
  double const limit = largest_stable_step<Stepper>(slab.field_bound(), slab.damping);
  for (double const fraction : {0.25, 0.5, 0.9}) {
    Spins spins = copy_of(start);
    Stepper stepper(spins);
    double const first = energy(exec, slab.field(), spins).value;
    double last = first;
    int rises = 0;
    for (int n = 0; n < steps; ++n) {
      stepper.step(exec, generator, spins, n * fraction * limit, fraction * limit);
      double const now = energy(exec, slab.field(), spins).value;
      if (now - last > 1e-11 * std::abs(first)) ++rises;
      last = now;
    }
    std::printf("    %-26s damping %-5g %4g of the limit: %d rises, energy %.3f -> %.3f\n", method,
                slab.damping, fraction, rises, first, last);
    EXPECT_EQ(rises, 0) << method << " damping " << slab.damping << " fraction " << fraction;
    EXPECT_LT(last, first - 100);
  }
}

TEST(Dissipation, EnergyFallsInEveryStep) {
  for (double const damping : {0.05, 0.5, 2.0}) {
    Slab const slab = block(damping);
    expect_no_rise<LieEuler<Spins>>("geometric Euler, default", slab.natural(), slab);
    expect_no_rise<LieEuler<Spins>>("geometric Euler, orthogonal", slab.orthogonal(), slab);
    expect_no_rise<LieHeun<Spins>>("geometric Heun, default", slab.natural(), slab);
    expect_no_rise<LieHeun<Spins>>("geometric Heun, orthogonal", slab.orthogonal(), slab);
    expect_no_rise<Rkmk4<Spins>>("rkmk4, default", slab.natural(), slab);
    expect_no_rise<Rkmk4<Spins>>("rkmk4, orthogonal", slab.orthogonal(), slab);
  }
}

}  // namespace
