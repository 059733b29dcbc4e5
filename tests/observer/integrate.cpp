// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// integrate() around a stepper: times, calls of observers, early ends, counts.
#include "../support/backends.hpp"
#include "../support/wrong_call.hpp"

#include <cayspin/cayspin.hpp>

#include <cayspin_paper/rkmk4_as_printed.hpp>

#include <limits>
#include <stdexcept>

namespace cayspin::test {

/// A generator that counts the evaluations of its A, on one site in host memory, and stores their
/// times.
struct CountingGenerator {
  std::int64_t* evaluations;
  std::vector<double>* times;

  struct Prepared {
    std::int64_t* evaluations;
    template <class Stencil>
    KOKKOS_FUNCTION auto operator()(Stencil const& stencil) const {
      ++*evaluations;
      return stencil.center();
    }
  };
  template <class Exec, class Spins>
  Prepared prepare(Exec const&, Spins const&, double t) const {
    times->push_back(t);
    return {evaluations};
  }
};

namespace {

/// A stepper that leaves the spins as they are and stores the start and length of each step; not
/// copyable.
template <class Spins>
struct Remembering {
  using spins_type = Spins;
  static constexpr int evaluations = 3;
  std::vector<double> starts, steps;

  Remembering() = default;
  Remembering(Remembering const&) = delete;

  template <class Exec, class Generator>
  void step(Exec const&, Generator const&, Spins&, double t, double dt) {
    starts.push_back(t);
    steps.push_back(dt);
  }
};

template <class Backend>
class Integrate : public ::testing::Test {
 protected:
  using Spins = typename Backend::Spins;
  typename Backend::Exec exec;
  RigidBody generator = RigidBody::principal(1, 2, 3);
  Spins spins = Spins("spins", Lattice::chain(3));
  Remembering<Spins> stepper;
  std::vector<Step> seen;

  auto remember() {
    return [this](auto const&, Step const& step, auto const&) { seen.push_back(step); };
  }
  std::vector<std::int64_t> numbers() const {
    std::vector<std::int64_t> all;
    for (auto const& step : seen) all.push_back(step.number);
    return all;
  }
};
TYPED_TEST_SUITE(Integrate, Backends, BackendName);

using Numbers = std::vector<std::int64_t>;

// 0.1 is not exact: times found by repeated addition would differ in the last digits.
TYPED_TEST(Integrate, TimesAreProducts) {
  Times const times{-1.5, 0.1, 1000};
  Summary const summary =
      integrate(this->exec, this->stepper, this->generator, this->spins, times, this->remember());
  ASSERT_EQ(this->seen.size(), 1001U);
  ASSERT_EQ(this->stepper.starts.size(), 1000U);
  for (std::int64_t n = 0; n <= 1000; ++n) {
    double const expected = -1.5 + static_cast<double>(n) * 0.1;
    EXPECT_EQ(this->seen[n].number, n);
    EXPECT_EQ(this->seen[n].time, expected);
    EXPECT_EQ(this->seen[n].dt, 0.1);
    EXPECT_EQ(this->seen[n].last, n == 1000);
    if (n == 1000) break;
    EXPECT_EQ(this->stepper.starts[n], expected);
  }
  for (double const dt : this->stepper.steps) EXPECT_EQ(dt, 0.1);
  EXPECT_EQ(summary.steps, 1000);
  EXPECT_EQ(summary.evaluations, 3000);
  EXPECT_FALSE(summary.stopped);
  EXPECT_GE(summary.step_seconds, 0);
}

TYPED_TEST(Integrate, EveryThinsOutAndNeverMissesTheEnds) {
  integrate(this->exec, this->stepper, this->generator, this->spins, {0, 0.1, 10},
            Every(4, this->remember()));
  EXPECT_EQ(this->numbers(), (Numbers{0, 4, 8, 10}));
  this->seen.clear();
  integrate(this->exec, this->stepper, this->generator, this->spins, {0, 0.1, 9},
            Every(3, this->remember()));
  EXPECT_EQ(this->numbers(), (Numbers{0, 3, 6, 9}));
  EXPECT_THROW(Every(0, this->remember()), std::invalid_argument);
}

TYPED_TEST(Integrate, EveryLeavesOutWhatItsObserverDoesNotWant) {
  integrate(this->exec, this->stepper, this->generator, this->spins, {0, 0.1, 13},
            Every(4, Every(6, this->remember())));
  EXPECT_EQ(this->numbers(), (Numbers{0, 12, 13}));
}

TYPED_TEST(Integrate, ObserversAreCalledEachWhenDueAndInOrder) {
  std::vector<int> who;
  integrate(this->exec, this->stepper, this->generator, this->spins, {0, 0.1, 4},
            Every(2, [&](auto const&, Step const&, auto const&) { who.push_back(1); }),
            [&](auto const&, Step const&, auto const&) { who.push_back(2); });
  EXPECT_EQ(who, (std::vector<int>{1, 2, 2, 1, 2, 2, 1, 2}));
}

// When one observer stops the run at a step, the others are still called at that step.
TYPED_TEST(Integrate, AnObserverEndsIt) {
  auto const stop_at = [](std::int64_t number) {
    return [number](auto const&, Step const& step, auto const&) {
      return step.number == number ? Next::stop : Next::proceed;
    };
  };
  auto const run = [&](std::int64_t number) {
    this->seen.clear();
    return integrate(this->exec, this->stepper, this->generator, this->spins, {0, 0.1, 5},
                     stop_at(number), this->remember());
  };
  Summary const early = run(2);
  EXPECT_EQ(this->numbers(), (Numbers{0, 1, 2}));
  EXPECT_EQ(early.steps, 2);
  EXPECT_TRUE(early.stopped);
  EXPECT_EQ(run(0).steps, 0);
  Summary const at_the_end = run(5);
  EXPECT_EQ(at_the_end.steps, 5);
  EXPECT_FALSE(at_the_end.stopped);
  auto thinned = Every(3, stop_at(3));
  Summary const by_every =
      integrate(this->exec, this->stepper, this->generator, this->spins, {0, 0.1, 9}, thinned);
  EXPECT_EQ(by_every.steps, 3);
  EXPECT_TRUE(by_every.stopped);
}

TYPED_TEST(Integrate, ObserversAfterOneThatStopsAreTold) {
  std::vector<bool> told;
  integrate(
      this->exec, this->stepper, this->generator, this->spins, {0, 0.1, 5}, this->remember(),
      [](auto const&, Step const& step, auto const&) {
        return step.number == 2 ? Next::stop : Next::proceed;
      },
      [&](auto const&, Step const& step, auto const&) { told.push_back(step.stops); });
  EXPECT_EQ(told, (std::vector<bool>{false, false, true}));
  for (auto const& step : this->seen) EXPECT_FALSE(step.stops);
}

// Like integrate(), Every refers to observers that are variables, and moves only temporaries into
// itself.
TYPED_TEST(Integrate, EveryRefersToObserversWithNames) {
  using Spins = typename TypeParam::Spins;
  copy_from_host(random_directions(3, 9), this->spins);
  LandauLifshitz const conserving(EffectiveField(Zeeman{{0, 0, 1}}), 0);
  LieEuler<Spins> stepper(this->spins);
  double const before = energy(this->exec, conserving, this->spins).value;
  EnergyControl control(this->spins, conserving), within(this->spins, conserving);
  integrate(this->exec, stepper, conserving, this->spins, {0, 0.1, 4}, Every(2, control),
            Every(1, std::ref(within)));
  ASSERT_TRUE(control.energy());
  EXPECT_EQ(*control.energy(), before);
  EXPECT_EQ(control.evaluations_done(), 3);
  EXPECT_EQ(within.evaluations_done(), 5);

  using Control = decltype(control);
  static_assert(std::is_same_v<decltype(Every(2, control)), Every<Control&>>);
  static_assert(std::is_same_v<decltype(Every(2, Control(control))), Every<Control>>);
  static_assert(detail::changes_spins<Every<Control&>>);
  static_assert(detail::changes_spins<std::reference_wrapper<Control>>);
  static_assert(detail::changes_spins<Every<std::reference_wrapper<Control>>>);
  // The due() of an observer in a std::reference_wrapper is called, too.
  EnergyControl seldom(this->spins, conserving, {.period = 3});
  integrate(this->exec, stepper, conserving, this->spins, {0, 0.1, 4}, std::ref(seldom));
  EXPECT_EQ(seldom.evaluations_done(), 2);
}

TYPED_TEST(Integrate, NoStepsIsOneLook) {
  Summary const summary = integrate(this->exec, this->stepper, this->generator, this->spins,
                                    {2, 0.1, 0}, this->remember());
  ASSERT_EQ(this->numbers(), (Numbers{0}));
  EXPECT_TRUE(this->seen[0].last);
  EXPECT_EQ(this->seen[0].time, 2);
  EXPECT_EQ(summary.steps, 0);
  EXPECT_EQ(summary.evaluations, 0);
  EXPECT_TRUE(this->stepper.starts.empty());
  Summary const unseen =
      integrate(this->exec, this->stepper, this->generator, this->spins, {2, 0.1, 3});
  EXPECT_EQ(unseen.steps, 3);
}

TYPED_TEST(Integrate, WhatIsRefused) {
  auto const run = [&](Times const& times) {
    integrate(this->exec, this->stepper, this->generator, this->spins, times);
  };
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(run({0, nan, 1}), std::invalid_argument);
  EXPECT_THROW(run({nan, 0.1, 1}), std::invalid_argument);
  EXPECT_THROW(run({0, std::numeric_limits<double>::infinity(), 1}), std::invalid_argument);
  EXPECT_EQ(refusal([&] {
              run({0, 0.1, -1});
            }),
            "cayspin::integrate: steps is -1; it must be at least first, which is 0");
  EXPECT_EQ(refusal([&] { run({.dt = 0.1, .steps = 3, .first = 5}); }),
            "cayspin::integrate: steps is 3; it must be at least first, which is 5");
  EXPECT_TRUE(this->stepper.starts.empty());
}

TYPED_TEST(Integrate, RecordKeepsWhatItSees) {
  using Real = typename TypeParam::Real;
  copy_from_host(random_directions(3, 9), this->spins);
  LieEuler stepper(this->spins);
  std::vector<Sample> samples;
  integrate(this->exec, stepper, this->generator, this->spins, {1, 0.25, 4},
            Every(2, Record(this->generator, samples)));
  ASSERT_EQ(samples.size(), 3U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(samples[i].step, static_cast<std::int64_t>(2 * i));
    EXPECT_EQ(samples[i].time, 1 + 0.5 * static_cast<double>(i));
    EXPECT_LE(samples[i].norm_defect, 16 * epsilon<Real>);
  }
  EXPECT_EQ(samples[2].energy.value, energy(this->exec, this->generator, this->spins).value);
  EXPECT_EQ(samples[2].magnetization.y, magnetization(this->exec, this->spins).y);
  EXPECT_NE(samples[0].magnetization.y, samples[2].magnetization.y);
}

#if defined(KOKKOS_ENABLE_SERIAL)
template <class Stepper, class Spins>
void expect_counted(std::vector<double> const& stage_times) {
  std::int64_t evaluations = 0;
  std::vector<double> times;
  Spins spins("spins", Lattice::chain(1));
  Stepper stepper(spins);
  Summary const summary = integrate(Kokkos::Serial(), stepper,
                                    CountingGenerator{&evaluations, &times}, spins, {1, 0.5, 7});
  EXPECT_EQ(summary.evaluations, 7 * static_cast<std::int64_t>(stage_times.size()));
  EXPECT_EQ(evaluations, summary.evaluations);
  ASSERT_EQ(times.size(), 7 * stage_times.size());
  for (std::size_t i = 0; i < times.size(); ++i)
    EXPECT_EQ(times[i], 1 + 0.5 * (static_cast<double>(i / stage_times.size()) +
                                   stage_times[i % stage_times.size()]));
}

template <class Real>
class CountedEvaluations : public ::testing::Test {};
TYPED_TEST_SUITE(CountedEvaluations, Precisions, PrecisionName);

// On one site, each evaluation is one call, which the generator counts. The times are those of the
// stages.
TYPED_TEST(CountedEvaluations, AreWhatTheGeneratorSees) {
  using Spins = SpinField<TypeParam, Kokkos::HostSpace>;
  expect_counted<LieEuler<Spins>, Spins>({0});
  expect_counted<Rkmk4<Spins>, Spins>({0, 0.5, 0.5, 1});
  expect_counted<Rkmk4AsPrinted<Spins>, Spins>({0, 0.5, 0.5, 1});
  expect_counted<ClassicalHeun<Spins>, Spins>({0, 1});
}
#endif

}  // namespace
}  // namespace cayspin::test
