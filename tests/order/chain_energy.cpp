// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders of the energy error of an undamped coupled chain, during a time of 10 and for fixed step
// sizes. They differ from those on a single sphere (rigid_body.cpp).
#include "../support/larger.hpp"
#include "chain.hpp"

#include <cayspin_paper/analytic_sigma.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using namespace isotropy;
constexpr double end_time = 10;

Slab const slab = coupled_chain(0);

template <class Stepper, class Generator>
void expect_energy(char const* what, Generator const& generator, std::vector<int> const& ladder,
                   double order, double tolerance = 0.15) {
  expect_convergence(what, end_time, ladder, order, tolerance, [&](int steps, double dt) {
    auto spins = chain_start();
    Stepper stepper(spins);
    std::vector<Sample> samples;
    integrate(Space{}, stepper, generator, spins, Times{0, dt, steps}, Record(generator, samples));
    double largest = 0;
    for (auto const& sample : samples)
      largest = larger(largest, std::abs(sample.energy.value - samples[0].energy.value));
    return largest;
  });
}

// Numbers of steps. With the fine ones, order 4 would be lost in round-off.
std::vector<int> const fine{4000, 5657, 8000}, coarse{177, 250, 354, 500, 707};

TEST(ChainEnergyOrder, LieEuler) {
  expect_energy<LieEuler<Spins>>("sigma 0", slab.natural(), fine, 1);
  expect_energy<LieEuler<Spins, Analytic>>("analytic", slab.natural(), fine, 2);
  expect_energy<LieEuler<Spins, FiniteDifference>>("forward", slab.natural(), fine, 2);
  expect_energy<LieEuler<Spins, FiniteDifferenceBackward>>("backward", slab.natural(), fine, 2);
}

// On a single sphere, Heun's method has order 3 with both generators.
TEST(ChainEnergyOrder, OrderTwo) {
  expect_energy<LieHeun<Spins>>("Heun, default", slab.natural(), fine, 3);
  expect_energy<LieHeun<Spins>>("Heun, orthogonal", slab.orthogonal(), fine, 2);
  expect_energy<LieAdamsBashforth2<Spins>>("ab2, default", slab.natural(), fine, 2);
  expect_energy<LieAdamsBashforth2<Spins>>("ab2, orthogonal", slab.orthogonal(), fine, 2);
}

// Two terms of the error have orders 4 and 5 and opposite signs; an order in between is measured.
TEST(ChainEnergyOrder, Rkmk4) {
  expect_energy<Rkmk4<Spins>>("default", slab.natural(), coarse, 4.9, 0.2);
  expect_energy<Rkmk4<Spins>>("orthogonal", slab.orthogonal(), coarse, 4.2, 0.2);
}

TEST(ChainEnergyOrder, MidpointConserves) {
  for (double const dt : {0.01, 0.05, 0.1}) {
    auto spins = chain_start();
    double const before = energy(Space{}, slab.natural(), spins).value;
    ImplicitMidpoint stepper(spins);
    advance(stepper, slab.natural(), spins, dt, 100);
    expect_below("drift of 100 steps",
                 std::abs(energy(Space{}, slab.natural(), spins).value - before), 2e-13);
  }
}

}  // namespace
