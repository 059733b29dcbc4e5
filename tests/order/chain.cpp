// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders measured on a coupled chain whose torques do not commute, over step sizes fixed
// beforehand.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double end_time = 1, tolerance = 0.15;
std::vector<int> const ladder{40, 80, 160, 320};

Slab chain(double damping) {
  return {.lattice = Lattice::chain(8),
          .exchange = 1,
          .anisotropy = 0.8,
          .axis = {1, 2, 3},
          .demag = 0.7,
          .applied = {0.5, -0.7, 0.9},
          .damping = damping};
}

Spins start() { return random_spins(Lattice::chain(8), 3); }

class Order : public ::testing::TestWithParam<double> {
 protected:
  Slab const slab = chain(GetParam());
  Spins const reference = run<Rkmk4<Spins>>(slab.natural(), start(), end_time / 4000, 4000);

  template <class Stepper, class Generator, class... Options>
  void expect(char const* what, int order, Generator const& generator,
              Options const&... options) const {
    std::vector<double> dts, errors;
    for (int const steps : ladder) {
      dts.push_back(end_time / steps);
      auto const end = run<Stepper>(generator, start(), dts.back(), steps, options...);
      errors.push_back(largest_distance(end, reference));
    }
    std::printf("    %-30s errors %.2e .. %.2e\n", what, errors.front(), errors.back());
    expect_order(what, fitted_order(dts, errors), order, tolerance);
    EXPECT_EQ(Stepper::order, order);
  }
};

using isotropy::Constant;
using isotropy::Zero;
Constant const three{3};

TEST_P(Order, ReferenceIsConfirmedByClassicalRk4) {
  auto const other = run<ClassicalRk4<Spins>>(slab.natural(), start(), end_time / 4000, 4000);
  EXPECT_LT(largest_distance(other, reference), 1e-12);
}

TEST_P(Order, LieEuler) {
  expect<LieEuler<Spins>>("default", 1, slab.natural());
  expect<LieEuler<Spins>>("orthogonal", 1, slab.orthogonal());
  expect<LieEuler<Spins, Constant>>("sigma 3", 1, slab.natural(), three);
  expect<LieEuler<Spins, Zero, Exponential>>("exponential", 1, slab.natural());
}

TEST_P(Order, Rkmk4) {
  expect<Rkmk4<Spins>>("default", 4, slab.natural());
  expect<Rkmk4<Spins>>("orthogonal", 4, slab.orthogonal());
  expect<Rkmk4<Spins, Constant>>("sigma 3", 4, slab.natural(), three);
  expect<Rkmk4<Spins, Constant>>("orthogonal, sigma 3", 4, slab.orthogonal(), three);
}

TEST_P(Order, Rkmk4InExponentialCoordinates) {
  expect<Rkmk4<Spins, Zero, Exponential>>("default", 4, slab.natural());
  expect<Rkmk4<Spins, Constant, Exponential>>("orthogonal, sigma 3", 4, slab.orthogonal(), three);
}

TEST_P(Order, Rkmk4AsPrinted) {
  expect<Rkmk4AsPrinted<Spins>>("default", 3, slab.natural());
  expect<Rkmk4AsPrinted<Spins>>("orthogonal", 3, slab.orthogonal());
}

TEST_P(Order, Classical) {
  expect<ClassicalEuler<Spins>>("Euler", 1, slab.natural());
  expect<ClassicalHeun<Spins>>("Heun", 2, slab.natural());
  expect<ClassicalRk4<Spins>>("rk4", 4, slab.natural());
}

TEST_P(Order, Projected) {
  expect<ProjectedEuler<Spins>>("Euler", 1, slab.natural());
  expect<ProjectedHeun<Spins>>("Heun", 2, slab.natural());
  expect<ProjectedRk4<Spins>>("rk4", 4, slab.natural());
}

INSTANTIATE_TEST_SUITE_P(Damping, Order, ::testing::Values(0.05, 1.0));

}  // namespace
