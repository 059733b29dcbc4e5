// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The equation of an implicit step: roots by fixed-point iteration and by Newton's method; steps
// for which no root is found.
#include "../support/backends.hpp"
#include "../support/evaluate.hpp"
#include "../support/landau_lifshitz.hpp"
#include "../support/larger.hpp"

#include <gtest/gtest.h>

using namespace cayspin;
using namespace cayspin::test;

namespace {

template <class Real>
class ImplicitStep : public ::testing::Test {
 protected:
  using Field = SpinField<Real, Space::memory_space>;
  Slab const slab{.lattice = Lattice::chain(8),
                  .exchange = 1,
                  .anisotropy = 0.8,
                  .axis = {1, 2, 3},
                  .applied = {0.5, -0.7, 0.9},
                  .damping = 0.2};
  Field const start = random_spins<Field>(slab.lattice, 3);

  // Bound of the residual, from the solver's tolerance and the round-off of dt * A, where
  // dt * |A| < 6.
  static constexpr double bound = 50 * epsilon<Real>;

  static ImplicitLieEuler<Field> euler(Field const& like, ImplicitOptions options = {}) {
    return ImplicitLieEuler<Field>(like, {}, {}, options);
  }

  template <class Stepper>
  Field after(Stepper stepper, double dt) const {
    Field spins = copy_of(start);
    stepper.step(Space{}, slab.natural(), spins, 0, dt);
    return spins;
  }

  /// Returns the largest |m1 - cay(dt * A(p)) m0|, where p is m1 or the midpoint.
  double residual(Field const& end, double dt, bool middle) const {
    std::vector<double> point = numbers_of(end), from = numbers_of(start);
    if (middle)
      for (std::size_t i = 0; i < point.size(); ++i) point[i] = 0.5 * (point[i] + from[i]);
    auto const a = evaluated(Space{}, slab.natural(), spins_of<Spins>(slab.lattice, point));
    double largest = 0;
    for (std::int64_t site = 0; site < slab.lattice.sites(); ++site)
      largest = larger(largest,
                       length(spin(end, site) - Cayley::rotate(dt * at(a, site), at(from, site))));
    return largest;
  }
};
TYPED_TEST_SUITE(ImplicitStep, Precisions, PrecisionName);

constexpr int fixed_point_alone = 0, newton_at_once = 0;

TYPED_TEST(ImplicitStep, BothRootsSolveTheEquation) {
  auto const& start = this->start;
  double const bound = this->bound, dt = 0.1;
  ImplicitOptions const fixed{8, 50, fixed_point_alone}, newton{8, newton_at_once, 30};
  auto const by_fixed_point = this->after(this->euler(start, fixed), dt);
  auto const by_newton = this->after(this->euler(start, newton), dt);
  EXPECT_LT(this->residual(by_fixed_point, dt, false), bound);
  EXPECT_LT(this->residual(by_newton, dt, false), bound);
  EXPECT_LT(largest_distance(by_fixed_point, by_newton), bound);

  auto const middle = this->after(ImplicitMidpoint(start, fixed), dt);
  auto const middle_by_newton = this->after(ImplicitMidpoint(start, newton), dt);
  EXPECT_LT(this->residual(middle, dt, true), bound);
  EXPECT_LT(this->residual(middle_by_newton, dt, true), bound);
  EXPECT_LT(largest_distance(middle, middle_by_newton), bound);
}

TYPED_TEST(ImplicitStep, NewtonSolvesWhatTheFixedPointDoesNot) {
  auto const& start = this->start;
  ImplicitOptions const fixed{8, 50, fixed_point_alone};
  for (double const dt : {0.6, 1.0}) {
    EXPECT_THROW(this->after(this->euler(start, fixed), dt), NotConverged) << dt;
    double const euler = this->residual(this->after(this->euler(start), dt), dt, false);
    double const middle = this->residual(this->after(ImplicitMidpoint(start), dt), dt, true);
    EXPECT_LT(euler, this->bound) << dt;
    EXPECT_LT(middle, this->bound) << dt;
  }
}

TYPED_TEST(ImplicitStep, WithoutRootLeavesTheSpins) {
  auto const& start = this->start;
  auto const before = copy_to_host(start);
  auto const expect_unchanged = [&](auto stepper) {
    auto spins = copy_of(start);
    try {
      stepper.step(Space{}, this->slab.natural(), spins, 0.5, 3.0);
      FAIL() << "converged";
    } catch (NotConverged const& error) {
      EXPECT_NE(std::string(error.what())
                    .find("is not solved: dt = 3 is too large, or the numbers are not finite"),
                std::string::npos)
          << error.what();
      EXPECT_EQ(error.t(), 0.5);
      EXPECT_EQ(error.dt(), 3);
    }
    EXPECT_EQ(copy_to_host(spins), before);
    // The stepper can still be used.
    stepper.step(Space{}, this->slab.natural(), spins, 0, 0.01);
    EXPECT_NE(copy_to_host(spins), before);
  };
  ImplicitOptions const fixed{8, 50, fixed_point_alone};
  expect_unchanged(this->euler(start, fixed));
  expect_unchanged(ImplicitMidpoint(start, fixed));
}

TEST(ImplicitStepCounts, Evaluations) {
  Slab const slab{.lattice = Lattice::chain(8), .exchange = 1, .applied = {0.5, -0.7, 0.9}};
  Spins spins = random_spins(slab.lattice, 3);
  ImplicitMidpoint stepper(spins);
  auto const few = integrate(Space{}, stepper, slab.natural(), spins, Times{0, 1e-3, 10});
  auto const more = integrate(Space{}, stepper, slab.natural(), spins, Times{0, 1e-1, 10});
  EXPECT_GE(few.evaluations, 30);
  EXPECT_GT(more.evaluations, few.evaluations);
  EXPECT_EQ(stepper.evaluations_done(), few.evaluations + more.evaluations);
}

}  // namespace
