// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Steps whose dt is chosen from a tolerance: the resulting error, and the behaviour when a field
// jumps, on failure, and at the end of a run.
#include "../backends/equal_bits.hpp"
#include "../order/chain.hpp"
#include "../support/backends.hpp"
#include "../support/field_that_jumps.hpp"

#include <cstdint>
#include <map>
#include <vector>

using namespace cayspin;
using namespace cayspin::test;

namespace {

using Tsit5 = AdaptiveRkmk<Spins, tableau::Tsitouras5>;

TEST(AdaptiveTolerance, TheErrorFollowsItOverSevenDecades) {
  Slab const slab = coupled_chain(0.05);
  auto const reference = run<Rkmk4<Spins>>(slab.natural(), chain_start(), 10. / 100000, 100000);
  std::vector<double> tolerances, errors;
  for (double const tolerance : {1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10}) {
    auto spins = chain_start();
    Tsit5 stepper(spins, {.tolerance = tolerance, .end = 10});
    stepper.step(Space(), slab.orthogonal(), spins, 0, 10);
    tolerances.push_back(tolerance);
    errors.push_back(largest_distance(spins, reference));
    EXPECT_LT(errors.back(), 30 * tolerance);
    if (errors.size() > 1) {
      EXPECT_LT(errors.back(), errors[errors.size() - 2]);
    }
    EXPECT_LT(stepper.rejected_steps(), stepper.accepted_steps() / 4);
    EXPECT_EQ(stepper.evaluations_done(),
              1 + 6 * (stepper.accepted_steps() + stepper.rejected_steps()));
  }
  expect_order("error over tolerance", fitted_order(tolerances, errors), 1, 0.1);
}

template <class Type>
struct AdaptiveOn : ::testing::Test {};
TYPED_TEST_SUITE(AdaptiveOn, Backends, BackendName);

// Serial and the threaded space choose the same steps and give bitwise identical spins, also at
// frames within a step. On a device, two runs are compared with each other.
TYPED_TEST(AdaptiveOn, HasTheBitsOfSerial) {
  using Field = typename TypeParam::Spins;
  using Exec = typename TypeParam::Exec;
  using Again = std::conditional_t<detail::is_host_execution<Exec>, Host, Exec>;
  for (auto const& shape : {std::array<std::int64_t, 3>{9, 7, 5}, {61, 37, 3}}) {
    Lattice const lattice{shape, {1, 1, 1}, {Boundary::open, Boundary::periodic, Boundary::open}};
    auto const generator = every_term(lattice).natural();
    auto const numbers = [&](auto exec) {
      auto spins = random_spins<Field>(lattice, 5);
      AdaptiveRkmk<Field, tableau::Tsitouras5> stepper(spins, {.tolerance = 1e-4});
      for (int frame = 0; frame < 3; ++frame)
        stepper.step(exec, generator, spins, frame * 0.37, 0.37);
      return copy_to_host(spins);
    };
    expect_equal_bits(numbers(Exec()), numbers(Again()), name_of(lattice));
  }
}

TEST(AdaptiveTolerance, HoldsAcrossAFieldSwitchedOnInMidStep) {
  double const jump = 0.5123456789;
  LandauLifshitz const before(EffectiveField(Zeeman{{0, 0, 1}}), 0.1);
  LandauLifshitz const after(EffectiveField(Zeeman{{3, 0, 0}}), 0.1);
  auto const start = [] {
    return make_spins(Lattice::chain(1), [](auto...) { return Vector{0.6, 0.3, 0.2}; });
  };
  auto exact = run<Rkmk4<Spins>>(before, start(), jump / 10000, 10000);
  exact = run<Rkmk4<Spins>>(after, exact, (1 - jump) / 10000, 10000);
  for (double const tolerance : {1e-3, 1e-5, 1e-7}) {
    auto spins = start();
    Tsit5 stepper(spins, {.tolerance = tolerance, .max_dt = 0.1});
    stepper.step(Space(),
                 LandauLifshitz(EffectiveField(FieldThatJumps{jump, {0, 0, 1}, {3, 0, 0}}), 0.1),
                 spins, 0, 1);
    EXPECT_GT(stepper.rejected_steps(), 0);
    expect_below("error across the jump", largest_distance(spins, exact), 30 * tolerance);
  }
}

// Without a field, steps become long. The rotation in the step in which the field is switched on is
// so large that the Cayley map turns any estimate of it into nearly half a turn: the embedded
// solutions agree although both are wrong.
TEST(AdaptiveTolerance, HoldsWhereAFieldIsSwitchedOnAtRest) {
  double const tolerance = 1e-4;
  auto const start = [] {
    return make_spins(Lattice::chain(1), [](auto...) { return Vector{0.6, 0, 0.8}; });
  };
  auto const exact = run<Rkmk4<Spins>>(LandauLifshitz(EffectiveField(Zeeman{{0, 0, 1}}), 0.1),
                                       start(), 1e-3, 3500);
  auto spins = start();
  AdaptiveRkmk<Spins, tableau::DormandPrince5> stepper(spins, {.tolerance = tolerance});
  LandauLifshitz const generator(EffectiveField(FieldThatJumps{2.5, {0, 0, 0}, {0, 0, 1}}), 0.1);
  for (double t = 0; t < 6; ++t) stepper.step(Space(), generator, spins, t, 1);
  expect_below("error after the jump", largest_distance(spins, exact), 30 * tolerance);
}

/// A short pulse, which a long step at equilibrium would miss.
struct Pulse {
  static constexpr bool depends_on_time = true;
  double begin, end;

  template <class Exec, class Field>
  Zeeman prepare(Exec const&, Field const&, double t) const {
    return Zeeman{{t > begin && t < end ? 1.0 : 0.0, 0, 1}};
  }
};

// Behaviour that methods with adaptive steps have in common.
template <class Stepper>
struct EveryAdaptive : ::testing::Test {};
using AllAdaptive =
    ::testing::Types<AdaptiveRkmk<Spins>, AdaptiveProjected<Spins>, AdaptiveStiffGauss2<Spins>>;
TYPED_TEST_SUITE(EveryAdaptive, AllAdaptive);

TYPED_TEST(EveryAdaptive, NumbersThatAreNotFiniteAreRefusedAndTheSpinsKept) {
  auto spins = chain_start();
  auto const start = copy_to_host(spins);
  FieldThatJumps const failing{0.5, {1, 0, 1}, {std::nan(""), 0, 1}};
  LandauLifshitz const generator(EffectiveField(Exchange(spins.lattice(), 1), failing), 0.1);
  TypeParam stepper(spins, {.tolerance = 1e-4});
  EXPECT_THROW(stepper.step(Space(), generator, spins, 0, 1), StepTooSmall);
  EXPECT_EQ(copy_to_host(spins), start);
  stepper.reset();
  stepper.step(Space(), generator, spins, 0, 0.25);
  EXPECT_NE(copy_to_host(spins), start);
}

// Leftovers of failed attempts are not mistaken for the previous step.
TYPED_TEST(EveryAdaptive, AfterAFailureStepsBeginAnew) {
  auto spins = chain_start();
  FieldThatJumps const failing{0.5, {1, 0, 1}, {std::nan(""), 0, 1}};
  LandauLifshitz const generator(EffectiveField(Exchange(spins.lattice(), 1), failing), 0.1);
  StepOptions const options{.tolerance = 1e-4, .first_dt = 0.01};
  TypeParam stepper(spins, options);
  stepper.step(Space(), generator, spins, 0, 0.001);
  EXPECT_THROW(stepper.step(Space(), generator, spins, 0.001, 1), StepTooSmall);
  auto anew = copy_of(spins);
  TypeParam other(anew, options);
  stepper.step(Space(), generator, spins, 0.001, 0.001);
  other.step(Space(), generator, anew, 0.001, 0.001);
  EXPECT_EQ(copy_to_host(spins), copy_to_host(anew));
}

TYPED_TEST(EveryAdaptive, AskingOftenDoesNotChangeTheSteps) {
  Slab const slab = coupled_chain(0.05);
  auto seldom = chain_start(), often = chain_start();
  StepOptions const options{.tolerance = 1e-4, .end = 2};
  TypeParam one(seldom, options), many(often, options);
  one.step(Space(), slab.natural(), seldom, 0, 2);
  advance(many, slab.natural(), often, 2. / 256, 256);
  EXPECT_EQ(one.evaluations_done(), many.evaluations_done());
  EXPECT_EQ(copy_to_host(seldom), copy_to_host(often));
}

/// An observer that is due at certain step numbers and, unpredictably for the caller, at each
/// calls_to_a_sudden_one-th call of due().
struct LooksNowAndThen {
  int calls_to_a_sudden_one;
  std::map<std::int64_t, std::vector<double>> seen = {};
  mutable int calls = 0;

  bool due(Step const& step) const {
    bool const sudden = ++calls % calls_to_a_sudden_one == 0;
    return sudden || step.number % 17 == 3 || step.number % 40 == 4;
  }
  void operator()(Space const&, Step const& step, Spins const& spins) {
    seen[step.number] = copy_to_host(spins);
  }
};

TYPED_TEST(EveryAdaptive, LooksSeeTheBitsOfStepsThatAllDeliver) {
  std::int64_t const steps = 120;
  auto const start = random_spins<Spins>(Lattice{.shape = {9, 7, 5}}, 5);
  LandauLifshitz const generator(
      EffectiveField(Exchange(start.lattice(), 1), Zeeman{{0.3, 0.1, 1}}), 0.1);
  for (double const dt : {0.4, 0.04, 0.004})
    for (Path const path : {Path::pass, Path::sweep}) {
      SCOPED_TRACE(testing::Message() << dt << (path == Path::pass ? ", pass" : ", sweep"));
      auto spins = copy_of(start), one_by_one = copy_of(start);
      TypeParam stepper(spins, {.tolerance = 1e-4}), other(spins, {.tolerance = 1e-4});
      if constexpr (requires { stepper.use(path); }) {
        stepper.use(path);
        other.use(Path::pass);
      }
      std::vector<std::vector<double>> states{copy_to_host(one_by_one)};
      Times const times{0.3, dt, steps};
      for (std::int64_t step = 0; step < steps; ++step) {
        other.step(Space(), generator, one_by_one, times.at(step), dt);
        states.push_back(copy_to_host(one_by_one));
      }
      LooksNowAndThen looks{23};
      auto const summary = integrate(Space(), stepper, generator, spins, times, looks);
      if constexpr (requires { stepper.path(); }) {
        EXPECT_EQ(stepper.path(), path);
      }
      EXPECT_EQ(summary.steps, steps);
      EXPECT_EQ(stepper.accepted_steps(), other.accepted_steps());
      EXPECT_EQ(stepper.evaluations_done(), other.evaluations_done());
      EXPECT_EQ(copy_to_host(spins), states.back());
      EXPECT_GT(looks.seen.size(), 8u);
      for (auto const& [step, state] : looks.seen)
        EXPECT_EQ(state, states.at(static_cast<std::size_t>(step))) << step;
    }
}

TYPED_TEST(EveryAdaptive, AFailureLeavesTheSpinsOfTheLastLook) {
  auto spins = chain_start();
  FieldThatJumps const failing{0.5, {1, 0, 1}, {std::nan(""), 0, 1}};
  LandauLifshitz const generator(EffectiveField(Exchange(spins.lattice(), 1), failing), 0.1);
  TypeParam stepper(spins, {.tolerance = 1e-4});
  LooksNowAndThen looks{1000};
  EXPECT_THROW(integrate(Space(), stepper, generator, spins, {0, 0.05, 20}, looks), StepTooSmall);
  ASSERT_FALSE(looks.seen.empty());
  EXPECT_EQ(looks.seen.rbegin()->first, 4);
  EXPECT_EQ(copy_to_host(spins), looks.seen.rbegin()->second);
}

StepOptions with_jumps_of(Pulse const& pulse, double tolerance) {
  auto const around = [](double t) { return StepBound{t * (1 - 1e-15), t * (1 + 1e-15), 0}; };
  return {.tolerance = tolerance, .bounds = {around(pulse.begin), around(pulse.end)}};
}

TYPED_TEST(EveryAdaptive, EndsStepsWhereTheFieldJumps) {
  Pulse const pulse{500, 501.5};
  auto const start = [] {
    return make_spins(Lattice::chain(1), [](auto...) { return Vector{0, 0, 1}; });
  };
  auto exact = run<Rkmk4<Spins>>(LandauLifshitz(EffectiveField(Zeeman{{1, 0, 1}}), 0.5), start(),
                                 1.5 / 2000, 2000);
  exact =
      run<Rkmk4<Spins>>(LandauLifshitz(EffectiveField(Zeeman{{0, 0, 1}}), 0.5), exact, 5e-4, 1000);
  for (double const tolerance : {1e-3, 1e-6}) {
    auto spins = start();
    TypeParam stepper(spins, with_jumps_of(pulse, tolerance));
    LandauLifshitz const generator(EffectiveField(Pulse{pulse}), 0.5);
    stepper.step(Space(), generator, spins, 0, 502);
    expect_below("error after the pulse", largest_distance(spins, exact), 30 * tolerance);
    EXPECT_LT(stepper.rejected_steps(), 10) << "each part is smooth";
  }
}

TYPED_TEST(EveryAdaptive, AskingOftenDoesNotChangeStepsThatEndAtJumps) {
  Pulse const pulse{0.5, 0.75};
  LandauLifshitz const generator(EffectiveField(Exchange(chain_start().lattice(), 1), Pulse{pulse}),
                                 0.1);
  auto seldom = chain_start(), often = chain_start();
  TypeParam one(seldom, with_jumps_of(pulse, 1e-4)), many(often, with_jumps_of(pulse, 1e-4));
  one.step(Space(), generator, seldom, 0, 2);
  advance(many, generator, often, 2. / 256, 256);
  EXPECT_EQ(one.evaluations_done(), many.evaluations_done());
  EXPECT_LT(largest_distance(seldom, often), 1e-6);
}

TYPED_TEST(EveryAdaptive, KeepsStepsThatAreShorterThanTheirBounds) {
  Slab const slab = coupled_chain(0.05);
  auto free = chain_start(), bounded = chain_start();
  TypeParam one(free, {.tolerance = 1e-4, .end = 2});
  TypeParam other(bounded, {.tolerance = 1e-4, .end = 2, .bounds = {{0.3, 0.9, 10}, {0.9, 2, 5}}});
  one.step(Space(), slab.natural(), free, 0, 2);
  other.step(Space(), slab.natural(), bounded, 0, 2);
  EXPECT_EQ(copy_to_host(free), copy_to_host(bounded));
}

TYPED_TEST(EveryAdaptive, AStepOfNoTimeAtRestSaysNothingOfTheNext) {
  auto spins = make_spins(Lattice::chain(8), [](auto...) { return Vector{0, 0, 1}; });
  auto const start = copy_to_host(spins);
  LandauLifshitz const generator(EffectiveField(Exchange(spins.lattice(), 1), Zeeman{{0, 0, 1}}),
                                 0.1);
  TypeParam stepper(spins, {.tolerance = 1e-4});
  for (double const dt : {0.0, 1.0}) {
    stepper.step(Space(), generator, spins, 0, dt);
    EXPECT_EQ(copy_to_host(spins), start) << dt;
  }
}

TYPED_TEST(EveryAdaptive, WhatCannotBeIsRefused) {
  auto spins = chain_start();
  for (StepOptions const& options :
       {StepOptions{.tolerance = 0}, StepOptions{.tolerance = 1e-15}, StepOptions{.tolerance = 2},
        StepOptions{.min_dt = -1}, StepOptions{.max_dt = 0}, StepOptions{.min_dt = 2, .max_dt = 1},
        StepOptions{.first_dt = -1}, StepOptions{.tolerance = std::nan("")},
        StepOptions{.bounds = {{1, 2, 0.1}, {1.5, 3, 0.1}}}, StepOptions{.bounds = {{1, 2, -0.1}}},
        StepOptions{.bounds = {{2, 1, 0.1}}}})
    EXPECT_THROW(TypeParam(spins, options), std::invalid_argument);
  TypeParam stepper(spins, {.tolerance = 1e-4, .end = 1});
  EXPECT_THROW(stepper.step(Space(), coupled_chain(0.1).natural(), spins, 0, -0.1),
               std::invalid_argument);
  EXPECT_THROW(stepper.step(Space(), coupled_chain(0.1).natural(), spins, 0, 1.1),
               std::invalid_argument);
}

// In a field of 1e30, t + dt rounds to t; in one of 1e200, the squares of the rates overflow, too.
TEST(AdaptiveFailure, FieldsTooStrongForTimeAreRefused) {
  for (double const field : {1e30, 1e200}) {
    auto spins = chain_start();
    auto const start = copy_to_host(spins);
    LandauLifshitz const generator(EffectiveField(Zeeman{{field, 0, 1}}), 0.1);
    Tsit5 stepper(spins, {.tolerance = 1e-6});
    try {
      stepper.step(Space(), generator, spins, 1, 1);
      ADD_FAILURE() << field;
    } catch (StepTooSmall const& error) {
      std::string const said = error.what();
      auto const number = said.find("a step below ");
      ASSERT_NE(number, std::string::npos) << said;
      EXPECT_GT(std::stod(said.substr(number + 13)), 0) << said;
      EXPECT_EQ(error.t(), 1);
      EXPECT_GT(error.dt(), 0);
      EXPECT_EQ(error.min_dt(), 0);
    }
    EXPECT_EQ(copy_to_host(spins), start);
  }
}

TEST(AdaptiveFailure, AStepBelowTheLeastAllowed) {
  auto spins = chain_start();
  Tsit5 stepper(spins, {.tolerance = 1e-10, .first_dt = 0.5, .min_dt = 0.4});
  EXPECT_THROW(stepper.step(Space(), coupled_chain(0.1).natural(), spins, 0, 1), StepTooSmall);
}

/// A field that is undefined after the time `end`.
struct EndingField {
  static constexpr bool depends_on_time = true;
  double end;
  template <class Exec, class Field>
  Zeeman prepare(Exec const&, Field const&, double t) const {
    if (t > end) throw std::logic_error("looked beyond the end");
    return Zeeman{{0, std::sqrt(end - t), 1}};
  }
};

// times.at(steps) and times.at(steps - 1) + dt may differ by the round-off of a large t.
TEST(AdaptiveEnd, IsReachedLateInARun) {
  Slab const slab = coupled_chain(0.05);
  for (std::int64_t steps = 1; steps <= 20; ++steps) {
    Times const times{1e6, 0.01, steps};
    auto spins = chain_start();
    Tsit5 stepper(spins, {.tolerance = 1e-6, .end = times.at(steps)});
    EXPECT_EQ(integrate(Space(), stepper, slab.orthogonal(), spins, times).steps, steps);
  }
}

TEST(AdaptiveEnd, NoStageLooksBeyondIt) {
  double const end = 1.7;
  auto spins = chain_start();
  LandauLifshitz const generator(EffectiveField(EndingField{end}), 0.1);
  Tsit5 stepper(spins, {.tolerance = 1e-3, .end = end});
  EXPECT_NO_THROW(advance(stepper, generator, spins, end / 17, 17));
  EXPECT_THROW(stepper.step(Space(), generator, spins, end, 0.1), std::invalid_argument);
}

TEST(AdaptiveAtRest, NothingMovesAndStepsGrow) {
  auto spins = make_spins(Lattice::chain(8), [](auto...) { return Vector{0, 0, 1}; });
  auto const start = copy_to_host(spins);
  Tsit5 stepper(spins, {.tolerance = 1e-6});
  stepper.step(Space(), LandauLifshitz(EffectiveField(Zeeman{{0, 0, 1}}), 0.1), spins, 0, 1e3);
  EXPECT_EQ(copy_to_host(spins), start);
  // Compilers for devices fuse other products and sums than those for hosts. On devices, the
  // estimated error is therefore round-off instead of zero.
  EXPECT_LT(stepper.accepted_steps(), detail::is_host_execution<Space> ? 20 : 30);
}

TEST(AdaptiveOptions, ToleranceBelowTheRoundOffOfSinglePrecisionIsRefused) {
  using Single = SpinField<float, Space::memory_space>;
  EXPECT_THROW((AdaptiveRkmk<Single, tableau::Tsitouras5>(Single("spins", Lattice::chain(2)),
                                                          {.tolerance = 1e-7})),
               std::invalid_argument);
}

}  // namespace
