// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders with a field that depends on time: in double, and in single precision for step sizes whose
// errors are above round-off.
#include "../support/evaluate.hpp"
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

#include <cayspin_paper/analytic_sigma.hpp>
#include <cayspin_paper/rkmk4_as_printed.hpp>

#include <array>

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
  expect_convergence(what, end_time, ladder, order, tolerance, [&](int steps, double dt) {
    return largest_distance(run<Stepper>(generator(), start<Field>(), dt, steps), reference);
  });
}

TEST(TimeDependentField, KeepsTheOrder) {
  std::vector<int> const ladder{40, 80, 160, 320};
  expect_slope<Rkmk4<Spins>>("rkmk4", 4, ladder);
  expect_slope<Rkmk<Spins, tableau::Kutta3>>("rkmk of Kutta's tableau", 3, ladder);
  expect_slope<Rkmk<Spins, tableau::ThreeEighths4>>("rkmk of the 3/8 tableau", 4, ladder);
  expect_slope<StereographicRungeKutta<Spins, tableau::Classical4>>("stereographic", 4, ladder);
  expect_slope<Rkmk4AsPrinted<Spins>>("rkmk4 as printed", 3, ladder);
  expect_slope<ClassicalHeun<Spins>>("classical Heun", 2, ladder);
  expect_slope<ProjectedRk4<Spins>>("projected rk4", 4, ladder);
}

/// Returns the largest component along A_o of the error of one step, divided by dt^2. With a
/// correct sigma it vanishes for small dt.
template <class Isotropy>
double local_error_along_generator(double dt) {
  constexpr double t = 0.4;
  Space const exec;
  auto const from = run<Rkmk4<Spins>>(generator(), start<Spins>(), t / 1000, 1000);
  auto fine = copy_of(from), coarse = copy_of(from), previous = copy_of(from);
  Rkmk4 exact(fine);
  for (int n = 0; n < 50; ++n) exact.step(exec, generator(), fine, t + n * dt / 50, dt / 50);
  LieEuler<Spins, Isotropy> stepper(coarse);
  if constexpr (requires { stepper.remember(exec, generator(), coarse, t, dt); }) {
    for (int n = 0; n < 50; ++n) exact.step(exec, generator(), previous, t - n * dt / 50, -dt / 50);
    stepper.remember(exec, generator(), previous, t - dt, dt);
  }
  stepper.step(exec, generator(), coarse, t, dt);
  auto const w = evaluated(exec, orthogonal(generator()), from, t);
  double largest = 0;
  for (std::int64_t site = 0; site < 8; ++site) {
    Vector const error = spin(coarse, site) - spin(fine, site);
    largest = larger(largest, std::abs(dot(error, at(w, site))) / length(at(w, site)));
  }
  return largest / (dt * dt);
}

TEST(TimeDependentField, SigmaTakesTheLocalErrorAlongTheGenerator) {
  auto const expect = [&]<class Isotropy>(char const* what, Isotropy, int order) {
    expect_convergence(what, 1, std::array{50, 100, 200, 400}, order, tolerance,
                       [](int, double dt) { return local_error_along_generator<Isotropy>(dt); });
  };
  using namespace isotropy;
  expect("sigma 0", Zero{}, 0);
  expect("analytic", Analytic{}, 1);
  expect("connection", Connection{}, 1);
  expect("forward", FiniteDifference{}, 1);
  expect("backward", FiniteDifferenceBackward{}, 1);
}

TEST(SinglePrecision, OrderAboveRoundOff) {
  expect_slope<LieEuler<SingleSpins>>("geometric Euler", 1, {40, 80, 160, 320});
  expect_slope<ProjectedHeun<SingleSpins>>("projected Heun", 2, {40, 80, 160});
  expect_slope<LieHeun<SingleSpins>>("geometric Heun", 2, {40, 80, 160});
  expect_slope<LieAdamsBashforth2<SingleSpins>>("ab2", 2, {40, 80, 160});
  expect_slope<ImplicitMidpoint<SingleSpins>>("implicit midpoint", 2, {40, 80, 160});
  expect_slope<Rkmk4<SingleSpins>>("rkmk4", 4, {10, 14, 20});
  expect_slope<ClassicalRk4<SingleSpins>>("classical rk4", 4, {10, 14, 20});
}

}  // namespace
