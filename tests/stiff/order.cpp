// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders of stiff steps, on a coupled chain whose rotations do not commute.
#include "../order/chain.hpp"

#include <cayspin/stepper/stiff_gauss.hpp>

namespace cayspin::test {
namespace {

using StiffOrder = ChainOrder;

TEST_P(StiffOrder, Two) { expect<StiffGauss2<Spins>>("stiff2", 2, slab.natural()); }

TEST_P(StiffOrder, Four) {
  ladder = {20, 40, 80, 160};
  expect<StiffGauss4<Spins>>("stiff4", 4, slab.natural());
}

TEST_P(StiffOrder, FourIsSolvedWellEnough) {
  for (int const steps : {40, 160}) {
    auto const error = [&](StiffOptions const& options) {
      auto const end =
          run<StiffGauss4<Spins>>(slab.natural(), chain_start(), end_time / steps, steps, options);
      return largest_distance(end, reference);
    };
    double const usual = error({}), solved = error({.tolerance = 1e-14});
    std::printf("    %d steps: %.2e, solved to round-off %.2e\n", steps, usual, solved);
    EXPECT_LT(usual, 1.5 * solved);
  }
}

INSTANTIATE_TEST_SUITE_P(Dampings, StiffOrder, ::testing::Values(0.0, 0.05, 1.0));

TEST(StiffGauss, InSinglePrecisionIsTheSameMethod) {
  using Single = SpinField<float, Space::memory_space>;
  Slab const slab = coupled_chain(0.1);
  auto const check = [&]<class InSingle, class InDouble>() {
    auto const single = run<InSingle>(slab.natural(), chain_start<Single>(), 0.02, 50);
    auto const full = run<InDouble>(slab.natural(), chain_start(), 0.02, 50);
    double const epsilon = std::numeric_limits<float>::epsilon();
    EXPECT_LT(largest_distance(single, full), 50 * 8 * epsilon);
  };
  check.operator()<StiffGauss2<Single>, StiffGauss2<Spins>>();
  check.operator()<StiffGauss4<Single>, StiffGauss4<Spins>>();
}

}  // namespace
}  // namespace cayspin::test
