// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders of explicit one-step methods on a coupled chain, over step sizes fixed beforehand.
#include "chain.hpp"

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

// Made for stability along the imaginary axis: up to 0.82 of dt omega per stage, RK4 0.71.
TEST_P(ChainOrder, SixStagesOfOrder4) {
  using tableau::Oscillatory64;
  expect<Rkmk<Spins, Oscillatory64>>("group", 4, slab.natural());
  expect<StereographicRungeKutta<Spins, Oscillatory64>>("chart", 4, slab.natural());
  expect<ProjectedRungeKutta<Spins, Oscillatory64>>("projected", 4, slab.natural());
  using Chart = StereographicRungeKutta<Spins, Oscillatory64>;
  auto const per_stage = [](double damping) { return largest_stable_step<Chart>(1, damping) / 6; };
  EXPECT_NEAR(per_stage(0.01), 0.819, 0.001);
  EXPECT_NEAR(per_stage(0.05), 0.818, 0.001);
  EXPECT_NEAR(per_stage(0.3), 0.650, 0.001);
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
