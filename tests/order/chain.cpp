// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders of explicit one-step methods on a coupled chain, for fixed step sizes.
#include "chain.hpp"

#include "../support/backends.hpp"
#include "../support/order_conditions.hpp"

#include <cayspin_paper/rkmk4_as_printed.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using isotropy::Constant;
using isotropy::Zero;
Constant const three{3};

TEST_P(ChainOrder, ReferenceIsConfirmedByClassicalRk4) {
  auto const other = run<ClassicalRk4<Spins>>(slab.natural(), chain_start(), end_time / 4000, 4000);
  EXPECT_LT(largest_distance(other, reference), 1e-12);
}

TEST_P(ChainOrder, LieEuler) {
  expect<LieEuler<Spins>>("default", 1, slab.natural());
  expect<LieEuler<Spins>>("orthogonal", 1, slab.orthogonal());
  expect<LieEuler<Spins, Constant>>("sigma 3", 1, slab.natural(), three);
  expect<LieEuler<Spins, Zero, Exponential>>("exponential", 1, slab.natural());
}

TEST_P(ChainOrder, LieHeun) {
  expect<LieHeun<Spins>>("default", 2, slab.natural());
  expect<LieHeun<Spins>>("orthogonal", 2, slab.orthogonal());
  expect<LieHeun<Spins, Constant>>("sigma 3", 2, slab.natural(), three);
  expect<LieHeun<Spins, Zero, Exponential>>("exponential", 2, slab.natural());
}

TEST_P(ChainOrder, Rkmk4) {
  expect<Rkmk4<Spins>>("default", 4, slab.natural());
  expect<Rkmk4<Spins>>("orthogonal", 4, slab.orthogonal());
  expect<Rkmk4<Spins, Constant>>("sigma 3", 4, slab.natural(), three);
  expect<Rkmk4<Spins, Constant>>("orthogonal, sigma 3", 4, slab.orthogonal(), three);
}

TEST_P(ChainOrder, Rkmk4InExponentialCoordinates) {
  expect<Rkmk4<Spins, Zero, Exponential>>("default", 4, slab.natural());
  expect<Rkmk4<Spins, Constant, Exponential>>("orthogonal, sigma 3", 4, slab.orthogonal(), three);
}

TEST_P(ChainOrder, RkmkOfAnyTableau) {
  expect<Rkmk<Spins, tableau::Kutta3>>("Kutta", 3, slab.natural());
  expect<Rkmk<Spins, tableau::ThreeEighths4>>("3/8", 4, slab.natural());
  expect<Rkmk<Spins, tableau::ThreeEighths4, Constant>>("3/8, sigma 3", 4, slab.natural(), three);
  expect<Rkmk<Spins, tableau::Kutta3, Zero, Exponential>>("exponential", 3, slab.natural());
}

TEST_P(ChainOrder, SixAndSevenStagesOfOrder4) {
  expect_on_group_chart_and_sphere<tableau::Oscillatory64>(slab.natural());
  expect_on_group_chart_and_sphere<tableau::Oscillatory74>(slab.natural());
}

TEST_P(ChainOrder, FiveStagesOfOrder4) {
  expect_on_group_chart_and_sphere<tableau::Damped54>(slab.natural());
}

TEST(ChainsOfStages, TakeLongSteps) {
  // Oscillatory64 is made for stability along the imaginary axis: dt * omega may be up to 0.82 per
  // stage, instead of RK4's 0.71.
  expect_stable_per_stage<StereographicRungeKutta<Spins, tableau::Oscillatory64>>(
      {{0.01, 0.819}, {0.05, 0.818}, {0.3, 0.650}}, 0.001);
  // Oscillatory74 is made for films: at every damping below 0.15, it takes longer steps per stage
  // than RK4, with smaller errors.
  expect_stable_per_stage<ProjectedRungeKutta<Spins, tableau::Oscillatory74>>(
      {{0, 0.7886}, {0.02, 0.8088}, {0.1, 0.7939}, {0.3, 0.6147}}, 0.0005);
}

TEST(Damped54, TakesAsLongStepsOfDecayAsRk4) {
  using Stepper = ProjectedRungeKutta<Spins, tableau::Damped54>;
  EXPECT_NEAR(largest_stable_step<Stepper>(1, 1, {.precession = false}) / 5, 0.701, 0.001);
  EXPECT_NEAR(largest_stable_step<ProjectedRk4<Spins>>(1, 1, {.precession = false}) / 4, 0.696,
              0.001);
}

TEST(Tableaux, SatisfyTheConditionsOfOrder4) {
  expect_conditions<tableau::Classical4>("RK4", 0x1p-50);
  expect_conditions<tableau::Damped54>("five stages", 0x1p-50);
  expect_conditions<tableau::Oscillatory64>("six stages", 3e-14);
  expect_conditions<tableau::Oscillatory74>("seven stages", 0x1p-50);
}

struct StoringProjected : update::Projected {
  static constexpr bool recovers_increments(int) { return false; }
};

template <class Field>
void expect_same_from_stored_increments(Slab const& slab) {
  using tableau::Oscillatory74;
  using Recovering = ProjectedRungeKutta<Field, Oscillatory74>;
  using Storing = RungeKutta<Field, Oscillatory74, StoringProjected, Zero>;
  auto const start = chain_start<Field>();
  Field stored = copy_of(start);
  Storing storing("Storing", stored);
  constexpr int steps = 100;
  double const dt = 1. / steps;
  integrate(Space(), storing, slab.natural(), stored, Times{0, dt, steps});
  auto const recovered = run<Recovering>(slab.natural(), start, dt, steps);
  ASSERT_GT(largest_distance(recovered, start), 0.1);
  EXPECT_NE(copy_to_host(recovered), copy_to_host(stored)) << "no other path";
  EXPECT_LT(largest_distance(recovered, stored), steps * epsilon<typename Field::value_type>);
}

TEST(ChainsOfStages, IncrementsFromSpinsAreTheStoredOnes) {
  expect_same_from_stored_increments<Spins>(coupled_chain(0.05));
  expect_same_from_stored_increments<SpinField<float, Space::memory_space>>(coupled_chain(0.05));
}

TEST_P(ChainOrder, Stereographic) {
  expect<StereographicRungeKutta<Spins, tableau::Heun>>("Heun", 2, slab.natural());
  expect<StereographicRungeKutta<Spins, tableau::Kutta3>>("Kutta", 3, slab.natural());
  expect<StereographicRungeKutta<Spins, tableau::Classical4>>("rk4", 4, slab.natural());
}

TEST_P(ChainOrder, Rkmk4AsPrinted) {
  expect<Rkmk4AsPrinted<Spins>>("default", 3, slab.natural());
  expect<Rkmk4AsPrinted<Spins>>("orthogonal", 3, slab.orthogonal());
}

TEST_P(ChainOrder, Classical) {
  expect<ClassicalEuler<Spins>>("Euler", 1, slab.natural());
  expect<ClassicalHeun<Spins>>("Heun", 2, slab.natural());
  expect<ClassicalRk4<Spins>>("rk4", 4, slab.natural());
}

TEST_P(ChainOrder, Projected) {
  expect<ProjectedEuler<Spins>>("Euler", 1, slab.natural());
  expect<ProjectedHeun<Spins>>("Heun", 2, slab.natural());
  expect<ProjectedRk4<Spins>>("rk4", 4, slab.natural());
}

INSTANTIATE_TEST_SUITE_P(Damping, ChainOrder, chain_dampings);

}  // namespace
