// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Steps that end on the energy they began with: the order of the stepper inside, the energy to
// round-off, for coupled spins and for rigid bodies.
#include "../order/chain.hpp"

#include <array>

using namespace cayspin;
using namespace cayspin::test;

namespace {

Slab const slab = coupled_chain(0);
RigidBody const body({1.1, 1.9, 2.0, 0.1, -0.6, 0.4});
constexpr double end_time = 1;
constexpr std::array ladder{40, 80, 160, 320};

template <class Stepper, class Generator>
void expect_order_and_energy(char const* what, Generator const& generator, int order) {
  auto const start = random_spins(slab.lattice, 3);
  auto const exact = run<Rkmk4<Spins>>(generator, start, end_time / 4000, 4000);
  double const before = energy(Space{}, generator, start).value;
  double worst = 0;
  expect_convergence(what, end_time, ladder, order, 0.15, [&](int steps, double dt) {
    Spins spins = copy_of(start);
    EnergyProjection stepper(spins, Stepper(spins), 12);
    advance(stepper, generator, spins, dt, steps);
    worst = std::max(worst, std::abs(energy(Space{}, generator, spins).value - before));
    EXPECT_LT(norm_defect(Space{}, spins), 1e-13);
    return largest_distance(spins, exact);
  });
  expect_below(what + std::string(", energy"), worst, 2e-13);
  EXPECT_EQ(EnergyProjection<Stepper>::order, order);
}

TEST(EnergyProjection, KeepsOrderAndEnergy) {
  auto const natural = slab.natural();
  expect_order_and_energy<LieEuler<Spins>>("Euler", natural, 1);
  expect_order_and_energy<LieHeun<Spins>>("Heun", natural, 2);
  expect_order_and_energy<LieAdamsBashforth2<Spins>>("ab2", natural, 2);
  expect_order_and_energy<Rkmk4<Spins>>("rkmk4", natural, 4);
  expect_order_and_energy<LieHeun<Spins>>("Heun, orthogonal", slab.orthogonal(), 2);
  expect_order_and_energy<LieHeun<Spins>>("bodies, Heun", body, 2);
}

// Euler's steps are so rough that each of the corrections still changes the energy.
TEST(EnergyProjection, CorrectsThreeTimesUnlessToldOtherwise) {
  Spins const start = random_spins(slab.lattice, 3);
  double const before = energy(Space{}, slab.natural(), start).value;
  auto const left = [&](auto... corrections) {
    Spins spins = copy_of(start);
    EnergyProjection stepper(spins, LieEuler(spins), corrections...);
    stepper.step(Space{}, slab.natural(), spins, 0, 0.2);
    return std::abs(energy(Space{}, slab.natural(), spins).value - before);
  };
  EXPECT_EQ(left(), left(3));
  EXPECT_GT(left(0), 10 * left(1));
  EXPECT_GT(left(1), 10 * left(2));
  EXPECT_GT(left(2), 10 * left(3));
  EXPECT_GT(left(3), 10 * left(4));
}

TEST(EnergyProjection, RefusesWhatDoesNotConserve) {
  Slab damped = slab;
  damped.damping = 0.1;
  Spins spins = random_spins(slab.lattice, 3);
  auto const before = copy_to_host(spins);
  EnergyProjection stepper(spins, LieHeun(spins));
  EXPECT_THROW(stepper.step(Space{}, damped.natural(), spins, 0, 0.1), std::invalid_argument);
  EXPECT_EQ(copy_to_host(spins), before);
}

TEST(EnergyProjection, LeavesWhatRests) {
  Spins const start = make_spins(slab.lattice, [](auto, auto, auto) { return Vector{0, 1, 0}; });
  auto const end = [&] {
    Spins spins = copy_of(start);
    EnergyProjection stepper(spins, LieHeun(spins));
    advance(stepper, RigidBody::principal(1, 2, 3), spins, 0.1, 5);
    return copy_to_host(spins);
  };
  EXPECT_EQ(end(), copy_to_host(start));
}

// What a stepper inside remembers is forgotten with each run.
TEST(EnergyProjection, RunsAreAlike) {
  Spins const start = random_spins(slab.lattice, 3);
  EnergyProjection stepper(start, LieAdamsBashforth2(start));
  auto const end = [&] {
    Spins spins = copy_of(start);
    integrate(Space{}, stepper, slab.natural(), spins, Times{0, 0.05, 4});
    return copy_to_host(spins);
  };
  auto const first = end();
  EXPECT_EQ(end(), first);
}

}  // namespace
