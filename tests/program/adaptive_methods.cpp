// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Methods that choose their steps by integrator.tolerance: their errors, the times of frames, and
// failures.
#include "io/method.hpp"
#include "program_test.hpp"

namespace cayspin::program::test {
namespace {

struct AdaptiveMethods : ProgramTest {
  std::vector<double> end(Arguments const& more) const { return end_of(chain_scene(), more); }

  /// Expects a run of the chain to end with this status, and with one line on standard error that
  /// contains `part`.
  void expect_end(int status, std::string const& part, Arguments const& more) const {
    auto const outcome = run_into("out.h5", chain_scene(), more);
    EXPECT_EQ(outcome.status, status);
    EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, part));
  }
};

TEST_F(AdaptiveMethods, FollowTheToleranceInAllCoordinates) {
  auto const exact = end(set("integrator.dt=0.0005", "integrator.steps=5000"));
  for (auto const* const method : io::methods()) {
    if (!method->adaptive) continue;
    std::vector<std::string> all{""};
    if (method->takes(io::Rotation::exponential)) all.emplace_back(",rotation='exponential'");
    if (method->takes(io::Generator::orthogonal)) all.emplace_back(",generator='orthogonal'");
    if (method->takes(io::Generator::tangent)) all.emplace_back(",generator='tangent'");
    if (method->takes(io::Isotropy::constant, io::SystemKind::llg))
      all.emplace_back(",isotropy={constant=0.7}");
    for (auto const& coordinates : all) {
      double errors[2];
      for (int i = 0; i < 2; ++i)
        errors[i] = distance(exact, end(set("integrator={method='" + std::string(method->word) +
                                            "',tolerance=" + (i == 0 ? "1e-4" : "1e-6") +
                                            coordinates + ",end=2.5}")));
      EXPECT_LT(errors[0], 30e-4) << method->word << coordinates;
      EXPECT_LT(errors[1], 30e-6) << method->word << coordinates;
      EXPECT_LT(errors[1], 0.1 * errors[0]) << method->word << coordinates;
    }
  }
}

TEST_F(AdaptiveMethods, WriteFramesAtTheTimesAskedFor) {
  std::string const method = "method='tsit5',tolerance=1e-7,end=2.5";
  auto const often = end(set("integrator={" + method + ",dt=0.1}", "output.every=5"));
  auto const times = read_dataset("out.h5", "/time").values;
  ASSERT_EQ(times.size(), 6U);
  for (std::size_t i = 0; i < times.size(); ++i) EXPECT_DOUBLE_EQ(times[i], 0.5 * double(i));
  auto const half = read_dataset("out.h5", "/spins").values;
  auto const once = end(set("integrator={" + method + "}", "output.every=128"));
  EXPECT_EQ(read_dataset("out.h5", "/time").values.size(), 2U);
  EXPECT_EQ(often, once);
  auto const exact = end(set("integrator.dt=0.0005", "integrator.steps=1000"));
  std::vector<double> const second(half.begin() + std::ptrdiff_t(once.size()),
                                   half.begin() + std::ptrdiff_t(2 * once.size()));
  EXPECT_LT(distance(second, exact), 30e-7);
}

// Observing a run more often does not change a bit of its final spins, and costs no evaluation.
TEST_F(AdaptiveMethods, TakeTheSameStepsHoweverOftenTheyAreLookedAt) {
  std::vector<double> ends[3];
  std::int64_t evaluations[3];
  std::string const looks[] = {"", ",dt=7.0", ",dt=0.25"};
  for (int i = 0; i < 3; ++i) {
    ends[i] = end(set("integrator={method='tsit5',tolerance=1e-6,end=7.0" + looks[i] + "}",
                      "output.every=128"));
    auto const info = info_of("out.h5");
    evaluations[i] = info.cost.evaluations;
    EXPECT_EQ(info.frames, 2) << looks[i];
    EXPECT_EQ(info.frame_times.back(), 7.0) << looks[i];
    if (i == 0) {
      EXPECT_EQ(info.frame_steps.back(), 128);
    }
  }
  for (int i : {1, 2}) {
    EXPECT_EQ(ends[i], ends[0]);
    EXPECT_EQ(evaluations[i], evaluations[0]);
  }
}

// Near equilibrium the energy may rise within the tolerance; energy_guard accepts that. The exact
// spin ends along z, to about exp(-200), and the tolerance bounds the error of a run.
TEST_F(AdaptiveMethods, ComeToRestUnderTheGuard) {
  for (std::string const method : {"tsit5", "bs3", "dp5"})
    for (std::string const tolerance : {"1e-1", "1e-3"}) {
      auto const last = end_of(macrospin_scene(), set("integrator={method='" + method +
                                                      "',tolerance=" + tolerance + ",end=400.0}"));
      EXPECT_LT(distance(last, std::vector<double>{0, 0, 1}), std::stod(tolerance)) << method;
    }
}

// The printed rate counts internal steps of the method, not observations.
TEST_F(AdaptiveMethods, TheRateCountsTheirOwnSteps) {
  auto const output = output_of({"run", "chain.toml", "--output", "out.h5", "--set",
                                 "integrator={method='tsit5',tolerance=1e-6,dt=40,steps=1}"});
  EXPECT_TRUE(contains(output, "out.h5: 1 step, 2 frames in "));
  auto const number_at = [&](std::string const& after) {
    return std::stod(output.substr(output.find(after) + after.size()));
  };
  auto const rate_at = output.find("stepping at ");
  ASSERT_NE(rate_at, std::string::npos) << output;
  double const own_steps = number_at("spin updates/s, ");
  auto const unit = output.substr(output.find("spin updates/s") - 1, 1);
  double const rate = number_at("stepping at ") * (unit == "M" ? 1e6 : unit == "k" ? 1e3 : 1);
  auto const seconds = info_of("out.h5").cost.step_seconds;
  EXPECT_GT(own_steps, 10);
  EXPECT_NEAR(rate, own_steps * 60 / seconds, 0.01 * rate) << output;
}

TEST_F(AdaptiveMethods, NumbersThatOverflowEndTheRunWithTheLastFrame) {
  expect_end(3, "the last good frame is",
             set("integrator={method='dp5',tolerance=1e-6,end=2.5,dt=0.5}",
                 "field.applied=['1e305*(t<1.2 ? 0 : 1)','0','1']"));
}

TEST_F(AdaptiveMethods, AStepBelowTheLeastEndsTheRun) {
  expect_end(3, "below",
             set("integrator={method='tsit5',tolerance=1e-12,end=2.5,min_dt=0.5,max_dt=0.6}"));
}

TEST_F(AdaptiveMethods, AToleranceBeyondThePrecisionIsRefused) {
  expect_end(
      2, "integrator.tolerance",
      {"--precision", "single", "--set", "integrator={method='tsit5',tolerance=1e-7,end=2.5}"});
}

}  // namespace
}  // namespace cayspin::program::test
