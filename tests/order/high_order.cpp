// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders 6 and 8, where a few steps are enough to reach round-off.
#include "../support/order_conditions.hpp"
#include "chain.hpp"

#include <cayspin/stepper/tableau_dormand_prince8.hpp>
#include <cayspin/stepper/tableau_order6.hpp>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using tableau::DormandPrince8;

class HighOrder : public ChainOrder {
 protected:
  HighOrder() {
    ladder = {5, 7, 10, 14};
    order_tolerance = 0.5;
  }
};

TEST_P(HighOrder, OnTheGroup) {
  using Stepper = Rkmk<Spins, DormandPrince8, isotropy::Constant>;
  expect<Stepper>("default", 8, slab.natural(), isotropy::Constant{0});
  expect<Stepper>("default, sigma 0.7", 8, slab.natural(), isotropy::Constant{0.7});
}

TEST_P(HighOrder, InTheChart) {
  expect<StereographicRungeKutta<Spins, DormandPrince8>>("tangent", 8, slab.natural());
}

TEST_P(HighOrder, InSpace) {
  ladder = {4, 5, 7, 10};
  expect<ProjectedRungeKutta<Spins, DormandPrince8>>("projected", 8, slab.natural());
}

TEST_P(HighOrder, EightStagesOfOrder6) {
  auto const expect_6 = [&]<class Tableau>(Tableau) {
    ladder = {12, 16, 23, 32};
    expect<Rkmk<Spins, Tableau>>("group", 6, slab.natural());
    expect<StereographicRungeKutta<Spins, Tableau>>("chart", 6, slab.natural());
    ladder = {23, 32, 45, 64};
    expect<ProjectedRungeKutta<Spins, Tableau>>("projected", 6, slab.natural());
  };
  expect_6(tableau::Oscillatory86());
  expect_6(tableau::Damped86());
}

// Oscillatory86 takes longer steps per evaluation than Dormand-Prince 5 up to a damping of 0.2.
TEST(Oscillatory86, IsStableOnTheImaginaryAxis) {
  expect_stable_per_stage<ProjectedRungeKutta<Spins, tableau::Oscillatory86>>(
      {{0, 0.4602}, {0.02, 0.4766}, {0.1, 0.5056}, {0.3, 0.4772}}, 0.0005);
}

TEST(Damped86, TakesLongStepsOfDecay) {
  using Stepper = Rkmk<Spins, tableau::Damped86>;
  EXPECT_NEAR(largest_stable_step<Stepper>(1, 1, {.precession = false}) / 8, 0.862, 0.001);
  EXPECT_NEAR(largest_stable_step<Stepper>(1, 1) / 8, 0.439, 0.001);
}

TEST(EightStages, SatisfyTheConditionsToRoundOff) {
  expect_conditions<DormandPrince8>("Dormand and Prince, order 8", 0x1p-40);
  expect_conditions<tableau::DormandPrince5>("Dormand and Prince, order 5", 0x1p-40, 1e-4);
  expect_conditions<tableau::Oscillatory86>("oscillatory", 0x1p-50);
  expect_conditions<tableau::Damped86>("damped", 0x1p-50);
}

INSTANTIATE_TEST_SUITE_P(Damping, HighOrder, chain_dampings);

}  // namespace
