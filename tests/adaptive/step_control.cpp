// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Compares the step controller with values computed by hand, and checks which error order each
// embedded tableau passes to it. Hairer and Wanner, Solving ODEs II, IV.2.
#include "../order/chain.hpp"

using namespace cayspin;
using namespace cayspin::test;

namespace {

using detail::StepController;

StepController controller(StepOptions const& options, int error_order = 5) {
  return StepController(options, error_order, 1e-14, "test");
}

/// A controller for errors of order 5, whose step tolerance is tolerance / 12.
class FifthOrder : public ::testing::Test {
 protected:
  StepController control = controller({.tolerance = 12e-6});

  /// Returns the ratio of the next dt to the last one after an error of `ratio` times the step
  /// tolerance.
  double factor(double ratio) { return control.next_dt(0.25, ratio * 1e-6) / 0.25; }
};

TEST_F(FifthOrder, TheErrorOfAnAcceptedStepEntersWithPower7Over50) {
  EXPECT_NEAR(factor(0x1p-10), 0.9 * 2.639015821545789, 1e-12);  // 2^(10 * 0.14)
}

TEST_F(FifthOrder, TheErrorBeforeEntersWithPower4Over50) {
  EXPECT_NEAR(factor(0x1p-10), 0.9 * 2.639015821545789, 1e-12);
  EXPECT_NEAR(factor(0x1p-5), 0.9 * 0.9330329915368074, 1e-12);  // 2^(5 * 0.14 - 10 * 0.08)
  EXPECT_NEAR(factor(1), 0.9 * 0.757858283255199, 1e-12);        // 2^(-5 * 0.08)
  control.reset();
  EXPECT_NEAR(factor(1), 0.9, 1e-12);
}

TEST_F(FifthOrder, ARejectedStepShrinksByTheFifthRoot) {
  EXPECT_NEAR(factor(1.5), 0.9 * 0.9221079114817278, 1e-12);
  EXPECT_NEAR(factor(0x1p5), 0.45, 1e-12);
  EXPECT_NEAR(factor(0x1p15), 0.1125, 1e-12);
  EXPECT_NEAR(factor(0x1p20), 0.1, 1e-12);
  EXPECT_NEAR(factor(std::nan("")), 0.1, 1e-12);
}

TEST_F(FifthOrder, TheStepAfterARejectedOneDoesNotGrow) {
  factor(0x1p5);
  EXPECT_NEAR(factor(0x1p-10), 1, 1e-12);
  // The rejected error does not count as the previous one.
  EXPECT_NEAR(factor(1), 0.9 * 0.5743491774985175, 1e-12);  // 2^(-10 * 0.08)
  EXPECT_GT(factor(0x1p-10), 1);
  factor(0x1p5);
  control.reset();
  EXPECT_GT(factor(0x1p-10), 1);
}

TEST_F(FifthOrder, GrowthEndsAtFiveAndSmallErrorsCountAsOneHundredMillionth) {
  EXPECT_NEAR(factor(0), 5, 1e-12);
  EXPECT_NEAR(factor(1), 0.9 * 0.2290867652767773, 1e-12);  // 10^(-8 * 0.08)
  factor(1e-8);
  EXPECT_NEAR(factor(1), 0.9 * 0.2290867652767773, 1e-12);
}

TEST_F(FifthOrder, AnErrorOfTheStepToleranceIsAccepted) {
  EXPECT_NEAR(control.step_tolerance(), 1e-6, 1e-20);
  EXPECT_TRUE(control.accepts(control.step_tolerance()));
  EXPECT_FALSE(control.accepts(std::nextafter(control.step_tolerance(), 1)));
  EXPECT_FALSE(control.accepts(std::nan("")));
}

TEST(StepControl, LowOrdersHaveASmallerStepTolerance) {
  EXPECT_NEAR(controller({.tolerance = 160e-6}, 4).step_tolerance(), 1e-6, 1e-20);
  EXPECT_NEAR(controller({.tolerance = 160e-6}, 3).step_tolerance(), 1e-6, 1e-20);
}

TEST(StepControl, ErrorsOfOrderThree) {
  auto control = controller({.tolerance = 160e-6}, 3);
  EXPECT_NEAR(control.next_dt(1, 0x1p-3 * 1e-6), 0.9 * 1.624504792712471, 1e-12);  // 2^0.7
  EXPECT_NEAR(control.next_dt(1, 1e-6), 0.9 * 0.757858283255199, 1e-12);           // 2^-0.4
  EXPECT_NEAR(control.next_dt(1, 8e-6), 0.45, 1e-12);
}

TEST(StepControl, TheFirstStepTurnsByHalfTheRootOfTheTolerance) {
  EXPECT_NEAR(controller({.tolerance = 12e-5}).first_dt(2, 7), 0.025, 1e-14);  // 0.1 / 2 / 2
  EXPECT_NEAR(controller({.tolerance = 160e-6}, 3).first_dt(2, 7), 0.0025, 1e-14);
  auto const given = controller({.first_dt = 0.125, .min_dt = 0.1, .max_dt = 0.5});
  EXPECT_EQ(given.first_dt(2, 7), 0.125);
  auto const limited = controller({.min_dt = 0.1, .max_dt = 0.5});
  EXPECT_EQ(limited.first_dt(1e9, 7), 0.1);
  EXPECT_EQ(limited.first_dt(1e-9, 7), 0.5);
  EXPECT_EQ(limited.first_dt(0, 0.25), 0.25);
  EXPECT_EQ(limited.first_dt(std::nan(""), 0.25), 0.25);
  EXPECT_EQ(limited.first_dt(std::numeric_limits<double>::infinity(), 0.25), 0.25);
}

TEST(StepControl, OptionsAtTheirLimitsAreTaken) {
  EXPECT_EQ(StepOptions::least_tolerance<float>(), 0x1p-18);
  EXPECT_EQ(StepOptions::least_tolerance<double>(), 0x1p-47);
  EXPECT_NO_THROW(controller({.tolerance = 1}));
  EXPECT_NO_THROW(controller({.tolerance = 1e-14}));
  EXPECT_NO_THROW(controller({.min_dt = 0.5, .max_dt = 0.5}));
  EXPECT_THROW(controller({.tolerance = 0.9e-14}), std::invalid_argument);
  EXPECT_THROW(controller({.min_dt = 0.5, .max_dt = 0.49}), std::invalid_argument);
}

TEST(StepControl, NoStepIsAboveTheLargest) {
  auto limited = controller({.tolerance = 12e-6, .max_dt = 0.5});
  EXPECT_EQ(limited.next_dt(0.4, 0), 0.5);
  auto free = controller({.tolerance = 12e-6});
  EXPECT_EQ(free.next_dt(9e99, 0), 1e100);
}

// A spin that turns by 1 radian per unit of time: the first dt shows which order the method gives
// to its error estimate.
template <class Stepper>
void expect_error_order(char const* name, int order, double divisor) {
  SCOPED_TRACE(name);
  LandauLifshitz const generator(EffectiveField(Zeeman{{0, 0, 1}}), 0);
  auto spins = make_spins(Lattice::chain(1), [](auto...) { return Vector{1, 0, 0}; });
  Stepper stepper(spins, {.tolerance = 1e-4});
  stepper.step(Space(), generator, spins, 0, 0);
  EXPECT_NEAR(stepper.next_dt(), 0.5 * std::pow(1e-4 / divisor, 1.0 / order), 1e-12);
}

TEST(StepControl, TheLastTwoStepsAreAlike) {
  EXPECT_EQ(detail::step_within(1, 0.375), 0.375);
  EXPECT_EQ(detail::step_within(1, 0.625), 0.5);
  for (double const dt : {1 - 1e-10, 1.0, 2.0}) EXPECT_EQ(detail::step_within(1, dt), 1);
}

TEST(StepControl, ErrorsAreOfTheEmbeddedOrderAndOne) {
  expect_error_order<AdaptiveRkmk<Spins, tableau::BogackiShampine3>>("3(2)", 3, 160);
  expect_error_order<AdaptiveRkmk<Spins, tableau::DormandPrince5>>("5(4)", 5, 12);
  expect_error_order<AdaptiveRkmk<Spins, tableau::Tsitouras5>>("Tsitouras", 5, 12);
  expect_error_order<AdaptiveProjected<Spins, tableau::DormandPrince5>>("projected", 5, 12);
}

TEST(StepBounds, EndLongStepsWhereTheyBegin) {
  detail::StepBounds const bounds({{1, 1.5, 0.125}, {2, 2.0 + 0x1p-50, 0}}, "");
  EXPECT_EQ(bounds.step(0, 0.25, 4).dt, 0.25);
  EXPECT_EQ(bounds.step(0, 100, 4).end, 1);
  EXPECT_EQ(bounds.step(0, 0.75, 4).end, 0.5);  // no very short step before the bound
  EXPECT_EQ(bounds.step(0.9375, 0.25, 4).dt, 0.125);
  EXPECT_EQ(bounds.step(1.25, 100, 4).dt, 0.125);
  EXPECT_EQ(bounds.step(1.5, 100, 4).end, 2);
  EXPECT_EQ(bounds.after_jump(2), 2.0 + 0x1p-50);
  EXPECT_EQ(bounds.after_jump(1.25), 1.25);
  EXPECT_EQ(bounds.step(bounds.after_jump(2), 100, 4).end, 4);
}

}  // namespace
