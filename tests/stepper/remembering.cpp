// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Steppers that store a field from one step to the next, and the cap on finite-difference sigmas.
#include "../support/evaluate.hpp"
#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

using isotropy::FiniteDifference;
using isotropy::FiniteDifferenceBackward;

Slab const chain{.lattice = Lattice::chain(8),
                 .exchange = 1,
                 .anisotropy = 0.8,
                 .axis = {1, 2, 3},
                 .applied = {0.5, -0.7, 0.9},
                 .damping = 0.2};

template <class Stepper>
class Remembering : public ::testing::Test {};
using Steppers =
    ::testing::Types<LieAdamsBashforth2<Spins>, LieEuler<Spins, FiniteDifferenceBackward>>;
TYPED_TEST_SUITE(Remembering, Steppers);

template <class Stepper>
class Forgetting : public ::testing::Test {};
using AllThatRemember =
    ::testing::Types<LieAdamsBashforth2<Spins>, LieEuler<Spins, FiniteDifferenceBackward>,
                     Compensated<Rkmk4<Spins>>>;
TYPED_TEST_SUITE(Forgetting, AllThatRemember);

TYPED_TEST(Forgetting, StartsAnewAfterReset) {
  Spins const start = random_spins(chain.lattice, 5);
  auto const fresh = copy_to_host(run<TypeParam>(chain.natural(), start, 0.05, 2));
  TypeParam stepper(start);
  auto const again = [&] {
    Spins spins = copy_of(start);
    advance(stepper, chain.natural(), spins, 0.05, 2);
    return copy_to_host(spins);
  };
  EXPECT_EQ(again(), fresh);
  EXPECT_NE(again(), fresh);
  stepper.reset();
  EXPECT_EQ(again(), fresh);

  Spins spins = copy_of(start);
  integrate(Space{}, stepper, chain.natural(), spins, Times{0, 0.05, 2});
  EXPECT_EQ(copy_to_host(spins), fresh);
}

// Given the state before its start, a first step equals the second step of a run.
TYPED_TEST(Remembering, StateBefore) {
  Spins const start = random_spins(chain.lattice, 5);
  Spins const after_one = run<TypeParam>(chain.natural(), start, 0.05, 1);
  Spins spins = copy_of(after_one);
  TypeParam stepper(spins);
  stepper.remember(Space{}, chain.natural(), start, 0, 0.05);
  advance(stepper, chain.natural(), spins, 0.05, 1, 1);
  EXPECT_EQ(copy_to_host(spins), copy_to_host(run<TypeParam>(chain.natural(), start, 0.05, 2)));
}

/// A field that throws after a given time.
struct FieldUntil {
  static constexpr bool depends_on_time = true;
  double end;
  template <class Exec, class Field>
  Zeeman prepare(Exec const&, Field const&, double t) const {
    if (t > end) throw std::runtime_error("no field");
    return Zeeman{{1, 0, 1}};
  }
};

TYPED_TEST(Remembering, AFirstStepThatFailedIsTakenAgain) {
  Spins const start = random_spins(chain.lattice, 5);
  auto const generator = [](double end) {
    return LandauLifshitz(EffectiveField(FieldUntil{end}), 0.2);
  };
  Spins spins = copy_of(start);
  TypeParam stepper(spins);
  EXPECT_THROW(stepper.step(Space{}, generator(0.01), spins, 0, 0.05), std::runtime_error);
  stepper.step(Space{}, generator(1), spins, 0, 0.05);
  EXPECT_EQ(copy_to_host(spins), copy_to_host(run<TypeParam>(generator(1), start, 0.05, 1)));
}

/// Takes pairs of steps. The first step of a pair takes a third of its time, the second the rest.
template <class Stepper>
Spins unequal_steps(Slab const& of, int pairs, double end_time) {
  Spins spins = random_spins(of.lattice, 5);
  Stepper stepper(spins);
  double t = 0;
  for (int n = 0; n < 2 * pairs; ++n) {
    double const dt = (n % 2 == 0 ? 1 : 2) * end_time / (3 * pairs);
    stepper.step(Space{}, of.natural(), spins, t, dt);
    t += dt;
  }
  return spins;
}

TEST(UnequalSteps, KeepTheOrder) {
  Spins const exact =
      run<Rkmk4<Spins>>(chain.natural(), random_spins(chain.lattice, 5), 1e-3, 1000);
  Slab undamped = chain;
  undamped.damping = 0;
  double const before = energy(Space{}, undamped.natural(), random_spins(chain.lattice, 5)).value;
  std::array const ladder{40, 80, 160, 320};  // pairs
  expect_convergence("ab2", 1, ladder, 2, 0.15, [&](int pairs, double) {
    return largest_distance(unequal_steps<LieAdamsBashforth2<Spins>>(chain, pairs, 1), exact);
  });
  expect_convergence("backward difference, energy", 1, ladder, 2, 0.15, [&](int pairs, double) {
    auto const end = unequal_steps<LieEuler<Spins, FiniteDifferenceBackward>>(undamped, pairs, 1);
    return std::abs(energy(Space{}, undamped.natural(), end).value - before);
  });
}

// LieEuler rotates by dt * w + clamp(dt * sigma) * m. Here sigma is written out.
TEST(FiniteDifference, CapOfTheTurn) {
  constexpr double dt = 0.1;
  Space const exec;
  auto const generator = orthogonal(chain.natural());
  Spins const start = random_spins(chain.lattice, 5);
  auto const w = evaluated(exec, generator, start);
  auto const predicted = evaluated(exec, generator, run<LieEuler<Spins>>(generator, start, dt, 1));
  double largest = 0;
  for (double const cap : {0.0, 0.01, 0.1, std::numeric_limits<double>::infinity()}) {
    auto const end = run<LieEuler<Spins, FiniteDifference>>(chain.natural(), start, dt, 1,
                                                            FiniteDifference{cap});
    auto const uncapped = run<LieEuler<Spins, FiniteDifferenceBackward>>(
        chain.natural(), start, dt, 1, FiniteDifferenceBackward{cap});
    EXPECT_EQ(copy_to_host(end), copy_to_host(uncapped)) << "the first step is a forward one";
    for (std::int64_t site = 0; site < 8; ++site) {
      Vector const m = spin(start, site), a = at(w, site);
      double const turn = -dot(at(predicted, site) - a, cross(a, m)) / dot(a, a);
      largest = larger(largest, std::abs(turn));
      Vector const f = dt * a + std::clamp(turn, -cap, cap) * m;
      EXPECT_LT(length(spin(end, site) - Cayley::rotate(f, m)), 1e-14) << cap << ' ' << site;
    }
  }
  EXPECT_GT(largest, 0.1) << "no spin that the caps bear on";
  for (double const cap : {-0.1, std::nan("")}) {
    EXPECT_THROW(LieEuler(start, FiniteDifference{cap}), std::invalid_argument);
    EXPECT_THROW(LieEuler(start, FiniteDifferenceBackward{cap}), std::invalid_argument);
  }
}

}  // namespace
