// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Order 8, where a few steps are enough to reach round-off.
#include "chain.hpp"

#include <cayspin/stepper/tableau_dormand_prince8.hpp>

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

TEST_P(HighOrder, InSinglePrecisionErrorsAreRoundOff) {
  using Field = SpinField<float, Space::memory_space>;
  constexpr int steps = 14;
  auto const end = run<StereographicRungeKutta<Field, DormandPrince8>>(
      slab.natural(), chain_start<Field>(), end_time / steps, steps);
  expect_below("tangent", largest_distance(end, reference), 4 * steps * 0x1p-23);
}

INSTANTIATE_TEST_SUITE_P(Damping, HighOrder, chain_dampings);

}  // namespace
