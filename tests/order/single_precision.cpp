// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders in single precision, over step sizes whose errors stand above round-off; and in double
// under a field that depends on time.
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

using SingleSpins = SpinField<float, Space::memory_space>;
constexpr double end_time = 1, tolerance = 0.15;

auto generator() {
  Lattice const lattice = Lattice::chain(8);
  auto const applied = [](double t) {
    return Vector{0.9 * std::cos(2 * t), 0.9 * std::sin(2 * t), 0.6 + 0.4 * std::sin(3 * t)};
  };
  return LandauLifshitz{EffectiveField{Exchange{lattice, 1}, UniaxialAnisotropy{0.8, {1, 2, 3}},
                                       TimeDependentZeeman{applied}},
                        0.3};
}

template <class Field>
Field start() {
  return random_spins<Field>(Lattice::chain(8), 3);
}

template <class Stepper>
void expect_slope(char const* what, int order, std::vector<int> const& ladder) {
  using Field = typename Stepper::spins_type;
  auto const reference = run<Rkmk4<Spins>>(generator(), start<Spins>(), end_time / 4000, 4000);
  std::vector<double> dts, errors;
  for (int const steps : ladder) {
    dts.push_back(end_time / steps);
    errors.push_back(
        largest_distance(run<Stepper>(generator(), start<Field>(), dts.back(), steps), reference));
  }
  std::printf("    %-30s errors %.2e .. %.2e\n", what, errors.front(), errors.back());
  expect_order(what, fitted_order(dts, errors), order, tolerance);
}

TEST(TimeDependentField, KeepsTheOrder) {
  std::vector<int> const ladder{40, 80, 160, 320};
  expect_slope<LieEuler<Spins>>("geometric Euler", 1, ladder);
  expect_slope<Rkmk4<Spins>>("rkmk4", 4, ladder);
  expect_slope<Rkmk4AsPrinted<Spins>>("rkmk4 as printed", 3, ladder);
  expect_slope<ClassicalHeun<Spins>>("classical Heun", 2, ladder);
  expect_slope<ProjectedRk4<Spins>>("projected rk4", 4, ladder);
}

TEST(SinglePrecision, OrderAboveRoundOff) {
  expect_slope<LieEuler<SingleSpins>>("geometric Euler", 1, {40, 80, 160, 320});
  expect_slope<ProjectedHeun<SingleSpins>>("projected Heun", 2, {40, 80, 160});
  expect_slope<Rkmk4<SingleSpins>>("rkmk4", 4, {10, 14, 20});
  expect_slope<ClassicalRk4<SingleSpins>>("classical rk4", 4, {10, 14, 20});
}

}  // namespace
