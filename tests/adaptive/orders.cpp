// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Orders of the embedded tableaux, with steps of fixed length: of the steps themselves, of the
// polynomial between them, and of the error that is estimated.
#include "../order/chain.hpp"
#include "../support/order_conditions.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

constexpr double steady_tolerance = 1;  // accepts all

StepOptions steps_of(double dt) {
  return {.tolerance = steady_tolerance, .first_dt = dt, .min_dt = dt, .max_dt = dt};
}

class Embedded : public ChainOrder {
 protected:
  Embedded() { ladder = {12, 24, 48, 96}; }

  /// At end_time, which is 3/10 into the last step.
  template <class Stepper, class Generator>
  void expect_between(char const* what, int order, Generator const& generator) const {
    std::vector<double> dts, errors;
    for (int const steps : ladder) {
      dts.push_back(end_time / (steps - 0.7));
      auto spins = chain_start();
      Stepper stepper(spins, steps_of(dts.back()));
      stepper.step(Space(), generator, spins, 0, end_time);
      EXPECT_EQ(stepper.accepted_steps(), steps);
      errors.push_back(largest_distance(spins, reference));
    }
    std::printf("    %-30s errors %.2e .. %.2e\n", what, errors.front(), errors.back());
    expect_order(what, fitted_order(dts, errors), order, order_tolerance + 0.4);
  }
};

TEST_P(Embedded, Tsitouras5) {
  order_tolerance = 1;  // its terms of order 5 are so small that those of order 6 show
  expect<Rkmk<Spins, tableau::Tsitouras5>>("default", 5, slab.natural());
  expect<StereographicRungeKutta<Spins, tableau::Tsitouras5>>("tangent", 5, slab.natural());
  expect_between<AdaptiveRkmk<Spins, tableau::Tsitouras5>>("between", 5, slab.orthogonal());
}

TEST_P(Embedded, DormandPrince5) {
  order_tolerance = 0.65;  // small terms of order 5 here too
  expect<Rkmk<Spins, tableau::DormandPrince5>>("default", 5, slab.natural());
  expect<ProjectedRungeKutta<Spins, tableau::DormandPrince5>>("projected", 5, slab.natural());
  expect_between<AdaptiveProjected<Spins, tableau::DormandPrince5>>("between", 5, slab.natural());
}

TEST_P(Embedded, BogackiShampine3) {
  ladder = {40, 80, 160, 320};
  expect<Rkmk<Spins, tableau::BogackiShampine3>>("default", 3, slab.natural());
  expect_between<AdaptiveRkmk<Spins, tableau::BogackiShampine3, isotropy::Zero, Exponential>>(
      "between", 3, slab.natural());
}

TEST_P(Embedded, CommutatorFree4) {
  ladder = {40, 80, 160, 320};
  expect<CommutatorFree4<Spins>>("default", 4, slab.natural());
  expect<CommutatorFree4<Spins, isotropy::Constant>>("orthogonal, sigma 3", 4, slab.orthogonal(),
                                                     isotropy::Constant{3});
}

TEST_P(Embedded, AdaptiveStepsAreThoseOfTheTableau) {
  double const dt = end_time / 32;
  auto spins = chain_start();
  AdaptiveRkmk<Spins, tableau::Tsitouras5> stepper(spins, steps_of(dt));
  advance(stepper, slab.natural(), spins, dt, 32);
  auto const plain = run<Rkmk<Spins, tableau::Tsitouras5>>(slab.natural(), chain_start(), dt, 32);
  expect_below("distance", largest_distance(spins, plain), 64 * 0x1p-52);
  EXPECT_EQ(stepper.evaluations_done(), 1 + 6 * 32);
}

template <class Embedded>
void expect_conditions(char const* name) {
  using Tableau = tableau::FirstSameAsLast<Embedded>;
  double const exact = 1e-13;
  auto const step = [](int i) { return Tableau::b[i]; };
  auto const embedded = [](int i) { return Tableau::b[i] - Tableau::error[i]; };
  for (int order = 1; order <= 5; ++order) {
    SCOPED_TRACE(std::string(name) + ", order " + std::to_string(order));
    if (order <= Embedded::order) {
      EXPECT_LT(defect<Tableau>(order, 1, step), exact);
    }
    if (order == Embedded::order + 1) {
      EXPECT_GT(defect<Tableau>(order, 1, step), 1e-3);
    }
    if (order <= Embedded::embedded_order) {
      EXPECT_LT(defect<Tableau>(order, 1, embedded), exact);
    }
    if (order == Embedded::embedded_order + 1) {
      EXPECT_GT(defect<Tableau>(order, 1, embedded), 1e-5);
    }
    for (double const s : {0.25, 0.7, 1.0}) {
      auto const between = [s](int i) {
        double weight = 0;
        for (int power = 5; power > 0; --power)
          weight = s * (weight + Tableau::dense[i][power - 1]);
        return weight;
      };
      if (order <= Embedded::dense_order) {
        EXPECT_LT(defect<Tableau>(order, s, between), exact);
      }
    }
  }
}

TEST(EmbeddedTableaux, SatisfyTheConditionsOfTheirOrders) {
  expect_conditions<tableau::BogackiShampine3>("Bogacki and Shampine");
  expect_conditions<tableau::DormandPrince5>("Dormand and Prince");
  expect_conditions<tableau::Tsitouras5>("Tsitouras");
}

INSTANTIATE_TEST_SUITE_P(Damping, Embedded, chain_dampings);

}  // namespace
