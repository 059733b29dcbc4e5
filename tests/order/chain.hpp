// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <array>

namespace cayspin::test {

inline Slab coupled_chain(double damping) {
  return {.lattice = Lattice::chain(8),
          .exchange = 1,
          .anisotropy = 0.8,
          .axis = {1, 2, 3},
          .demag = 0.7,
          .applied = {0.5, -0.7, 0.9},
          .damping = damping};
}

template <class Field = Spins>
Field chain_start() {
  return random_spins<Field>(Lattice::chain(8), 3);
}

/// Orders on a coupled chain whose torques do not commute; the parameter is the damping.
class ChainOrder : public ::testing::TestWithParam<double> {
 protected:
  Slab const slab = coupled_chain(GetParam());
  // Over-damped motions are shorter.
  double const end_time = std::min(1.0, 1 / GetParam());
  Spins const reference = run<Rkmk4<Spins>>(slab.natural(), chain_start(), end_time / 4000, 4000);

  /// Steps; round-off is not to be seen in the errors.
  std::array<int, 4> ladder = {40, 80, 160, 320};
  double order_tolerance = 0.15;

  template <class Stepper, class Generator, class... Options>
  void expect(char const* what, int order, Generator const& generator,
              Options const&... options) const {
    std::vector<double> dts, errors;
    for (int const steps : ladder) {
      dts.push_back(end_time / steps);
      auto const end = run<Stepper>(generator, chain_start(), dts.back(), steps, options...);
      errors.push_back(largest_distance(end, reference));
    }
    std::printf("    %-30s errors %.2e .. %.2e\n", what, errors.front(), errors.back());
    expect_order(what, fitted_order(dts, errors), order, order_tolerance);
    EXPECT_EQ(Stepper::order, order);
  }
};

inline auto const chain_dampings = ::testing::Values(0.05, 1.0, 10.0);

}  // namespace cayspin::test
