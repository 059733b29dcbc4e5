// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders of the embedded tableaux and of CommutatorFree4, from the convergence with constant steps.
// Order conditions of the tableaux also give the orders of their dense output and of their embedded
// solution.
#include "../order/chain.hpp"
#include "../support/order_conditions.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

class Embedded : public ChainOrder {
 protected:
  Embedded() { ladder = {12, 24, 48, 96}; }

  /// Expects adaptive steps of constant length to equal those of the plain stepper.
  template <class Adaptive, class Plain>
  void expect_same_steps(char const* what, int evaluations) const {
    double const dt = end_time / 32;
    auto spins = chain_start();
    Adaptive stepper(spins, {.tolerance = 1, .first_dt = dt, .min_dt = dt, .max_dt = dt});
    advance(stepper, slab.natural(), spins, dt, 32);
    auto const plain = run<Plain>(slab.natural(), chain_start(), dt, 32);
    expect_below(what, largest_distance(spins, plain), 64 * 0x1p-52);
    EXPECT_EQ(stepper.accepted_steps(), 32);
    EXPECT_EQ(stepper.evaluations_done(), 1 + evaluations * 32);
  }
};

TEST_P(Embedded, Tsitouras5) {
  order_tolerance = 1;  // its error terms of order 5 are so small that those of order 6 show
  expect<Rkmk<Spins, tableau::Tsitouras5>>("default", 5, slab.natural());
  expect<StereographicRungeKutta<Spins, tableau::Tsitouras5>>("tangent", 5, slab.natural());
}

TEST_P(Embedded, DormandPrince5) {
  order_tolerance = 0.65;  // its error terms of order 5 are small, too
  expect<Rkmk<Spins, tableau::DormandPrince5>>("default", 5, slab.natural());
  expect<ProjectedRungeKutta<Spins, tableau::DormandPrince5>>("projected", 5, slab.natural());
}

TEST_P(Embedded, BogackiShampine3) {
  ladder = {40, 80, 160, 320};
  expect<Rkmk<Spins, tableau::BogackiShampine3>>("default", 3, slab.natural());
}

TEST_P(Embedded, CommutatorFree4) {
  ladder = {40, 80, 160, 320};
  expect<CommutatorFree4<Spins>>("default", 4, slab.natural());
  expect<CommutatorFree4<Spins, isotropy::Constant>>("orthogonal, sigma 3", 4, slab.orthogonal(),
                                                     isotropy::Constant{3});
}

TEST_P(Embedded, AdaptiveStepsAreThoseOfTheTableau) {
  using namespace tableau;
  expect_same_steps<AdaptiveRkmk<Spins, Tsitouras5>, Rkmk<Spins, Tsitouras5>>("Tsitouras", 6);
  expect_same_steps<AdaptiveProjected<Spins, DormandPrince5>,
                    ProjectedRungeKutta<Spins, DormandPrince5>>("projected", 6);
  expect_same_steps<AdaptiveRkmk<Spins, BogackiShampine3, isotropy::Zero, Exponential>,
                    Rkmk<Spins, BogackiShampine3, isotropy::Zero, Exponential>>("3(2)", 3);
}

template <class Embedded>
void expect_conditions_of_all_weights(char const* name) {
  using Tableau = tableau::FirstSameAsLast<Embedded>;
  double const exact = 1e-13, not_asked = -1;
  expect_conditions<Tableau>(name, Embedded::order, exact, Embedded::order < 5 ? 1e-3 : not_asked,
                             [](int i) { return Tableau::b[i]; });
  expect_conditions<Tableau>(name, Embedded::embedded_order, exact, 1e-5,
                             [](int i) { return Tableau::b[i] - Tableau::error[i]; });
  for (double const s : {0.25, 0.7, 1.0}) {
    auto const between = [s](int i) {
      double weight = 0;
      for (int power = 5; power > 0; --power) weight = s * (weight + Tableau::dense[i][power - 1]);
      return weight;
    };
    expect_conditions<Tableau>(name, Embedded::dense_order, exact, not_asked, between, s);
  }
}

TEST(EmbeddedTableaux, SatisfyTheConditionsOfTheirOrders) {
  expect_conditions_of_all_weights<tableau::BogackiShampine3>("Bogacki and Shampine");
  expect_conditions_of_all_weights<tableau::DormandPrince5>("Dormand and Prince");
  expect_conditions_of_all_weights<tableau::Tsitouras5>("Tsitouras");
}

INSTANTIATE_TEST_SUITE_P(Damping, Embedded, chain_dampings);

}  // namespace
