// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Expensive fields: orders, stability where a single pass fails, and energies.
#include "long_range.hpp"

#include <algorithm>
#include <array>
#include <limits>

using namespace cayspin;
using namespace cayspin::test;

namespace {

Lattice const block{{5, 4, 3}, {1, 1.1, 0.9}, {Boundary::periodic, Boundary::open, Boundary::open}};

constexpr std::array ladder{20, 40, 80, 160};

template <int Order, class Inner>
void expect_order_of(char const* what, std::int64_t substeps, double order) {
  Spins const start = random_spins(block, 5);
  auto const slow = multirate_long_range(start, 0.4);
  auto const generator = with_multirate(block, 0.5, slow, 0.1, 0.6);
  Spins const exact = run<Rkmk4<Spins>>(generator, start, 1e-3, 1000);
  expect_convergence(what, 1, ladder, order, 0.15, [&](int steps, double dt) {
    Spins spins = copy_of(start);
    auto stepper = multirate<Order, Spins, Inner>(spins, slow, substeps);
    advance(stepper, generator, spins, dt, steps);
    return largest_distance(spins, exact);
  });
}

TEST(SlowField, Orders) {
  expect_order_of<2, Rkmk4<Spins>>("order 2", 2, 2);
  expect_order_of<3, Rkmk4<Spins>>("order 3", 2, 3);
  expect_order_of<4, Rkmk4<Spins>>("order 4", 2, 4);
  expect_order_of<3, Rkmk4<Spins>>("order 3, one substep", 1, 3);
  expect_order_of<4, LieHeun<Spins>>("order 4 between steps of Heun", 3, 2);
  static_assert(decltype(multirate<4, Spins, LieHeun<Spins>>(
                    std::declval<Spins>(), std::declval<MultirateLongRange<Spins>>(), 1))::order ==
                2);
}

template <int Order>
void expect_order_of_unequal_steps() {
  Spins const start = random_spins(block, 5);
  auto const slow = multirate_long_range(start, 0.4);
  auto const generator = with_multirate(block, 0.5, slow, 0.1, 0.6);
  Spins const exact = run<Rkmk4<Spins>>(generator, start, 1e-3, 1000);
  expect_convergence("unequal steps", 1, ladder, Order, 0.2, [&](int pairs, double) {
    Spins spins = copy_of(start);
    auto stepper = multirate<Order>(spins, slow, 2);
    double t = 0;
    for (int n = 0; n < 2 * pairs; ++n) {
      double const dt = (n % 2 == 0 ? 1 : 2) / (3. * pairs);
      stepper.step(Space{}, generator, spins, t, dt);
      t += dt;
    }
    EXPECT_EQ(stepper.slow_evaluations_done(), 2 * pairs + 1 + 2 * 4);
    return largest_distance(spins, exact);
  });
  expect_convergence("twice as long from the half on", 1, std::array{40, 80, 160, 320}, Order, 0.2,
                     [&](int steps, double) {
                       Spins spins = copy_of(start);
                       auto stepper = multirate<Order>(spins, slow, 2);
                       double const dt = 1. / (1.5 * steps);
                       advance(stepper, generator, spins, dt, steps);
                       for (int n = 0; 2 * n < steps / 2; ++n)
                         stepper.step(Space{}, generator, spins, (steps + 2 * n) * dt, 2 * dt);
                       return largest_distance(spins, exact);
                     });
}

TEST(SlowField, UnequalStepsKeepTheOrder) {
  expect_order_of_unequal_steps<3>();
  expect_order_of_unequal_steps<4>();
}

/// Takes steps without the second pass: the expensive field is only extrapolated from two values.
template <class Generator>
void extrapolate(MultirateLongRange<Spins> const& slow, Generator const& generator, Spins& spins,
                 double dt, int steps, int substeps) {
  Space const exec;
  Rkmk4<Spins> inner(spins);
  std::array<Spins, 2> values{Spins("now", spins.lattice()), Spins("before", spins.lattice())};
  std::array<double, 2> const nodes{0, -1};
  slow.evaluate(exec, spins, 0, values[1]);
  for (int n = 0; n < steps; ++n) {
    slow.evaluate(exec, spins, 0, values[0]);
    {
      MultirateLongRange<Spins>::Interpolated const between(slow, values, nodes, n * dt, dt);
      for (int k = 0; k < substeps; ++k)
        inner.step(exec, generator, spins, n * dt + k * dt / substeps, dt / substeps);
    }
    swap(values[0], values[1]);
  }
}

/// Returns the energy at the start and after each of `count` calls of go_on(spins).
template <class Advance, class Generator>
std::vector<double> energies(Generator const& generator, Spins const& start, int count,
                             Advance const& go_on) {
  Spins spins = copy_of(start);
  std::vector<double> found;
  for (int look = 0; look <= count; ++look) {
    found.push_back(sample(Space{}, generator, Step{}, spins).energy.value);
    if (look < count) go_on(spins);
  }
  return found;
}

// With 4 times the largest stable step of RK4, one pass gains energy, but two passes lose energy
// from sample to sample.
TEST(SlowField, SecondPassKeepsTheEnergyLaw) {
  Lattice const film{{24, 8, 1}, {1, 1, 1}, {Boundary::open, Boundary::open, Boundary::open}};
  Spins const start = make_spins(film, [](auto i, auto j, auto) {
    return Vector{std::cos(0.2 * i), std::sin(0.2 * i + 0.3 * j), 0.4 * std::cos(0.5 * j)};
  });
  double const exchange = 10, damping = 0.02;
  auto const slow = multirate_long_range(start, 0.25);
  auto const generator = with_multirate(film, exchange, slow, damping);
  double const stable =
      largest_stable_step<Rkmk4<Spins>>(exchange_bound(film, exchange) + 2, damping);
  double const dt = 4 * stable;
  int const substeps = 5, steps = 100;

  auto stepper = multirate(start, slow, substeps);
  double t = 0;
  auto const two_passes = energies(generator, start, 30, [&](Spins& spins) {
    for (int n = 0; n < steps; ++n, t += dt) stepper.step(Space{}, generator, spins, t, dt);
  });
  for (std::size_t i = 1; i < two_passes.size(); ++i)
    EXPECT_LT(two_passes[i], two_passes[i - 1]) << i;
  auto const one_pass = energies(generator, start, 30, [&](Spins& spins) {
    extrapolate(slow, generator, spins, dt, steps, substeps);
  });
  auto const rk4 = energies(generator, start, 1, [&](Spins& spins) {
    Rkmk4<Spins> fine(spins);
    advance(fine, generator, spins, 1.2 * stable, 500);
  });
  std::printf(
      "    E %.3f -> %.3f (two passes), %.3f (one pass), %.3f (rkmk4, dt 1.2 times stable)\n",
      two_passes.front(), two_passes.back(), one_pass.back(), rk4.back());
  EXPECT_GT(one_pass.back(), two_passes.front());
  EXPECT_GT(rk4.back(), rk4.front());

  // Also prints the error of RK4 with steps as long as a substep: that method evaluates the
  // expensive field 20 times in the time of one long step.
  Spins spins = copy_of(start);
  stepper.reset();
  advance(stepper, generator, spins, dt, 20);
  Spins const exact = run<Rkmk4<Spins>>(generator, start, stable / 4, 320);
  double const error = largest_distance(spins, exact);
  double const of_rk4 =
      largest_distance(run<Rkmk4<Spins>>(generator, start, dt / substeps, 20 * substeps), exact);
  std::printf("    after 20 steps: error %.2e, of rkmk4 %.2e\n", error, of_rk4);
  EXPECT_LT(error, 0.03);
}

TEST(SlowField, KeepsUnitLengthAndEnergyOfLooks) {
  Spins spins = random_spins(block, 5);
  LongRange const solver{0.4};
  auto const slow = multirate_long_range(spins, 0.4);
  auto const generator = with_multirate(block, 0.5, slow, 0.1);
  auto const plain = with_multirate(block, 0.5, HostField<Spins, LongRange>(spins, solver), 0.1);
  auto stepper = multirate(spins, slow, 3);
  advance(stepper, generator, spins, 0.05, 40);
  auto const evaluations = slow.evaluations_done();
  auto const seen = sample(Space{}, generator, Step{}, spins);
  EXPECT_EQ(slow.evaluations_done(), evaluations + 1);
  EXPECT_EQ(seen.energy.value, sample(Space{}, plain, Step{}, spins).energy.value);
  EXPECT_LT(seen.norm_defect, 100 * std::numeric_limits<double>::epsilon());
}

}  // namespace
