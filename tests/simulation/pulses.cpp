// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Fields that change within a small part of a run: adaptive steps resolve them, and constant steps
// that may miss them cause a warning.
#include "../support/larger.hpp"
#include "../support/random_pulses.hpp"
#include "random_run.hpp"
#include "scenes_of_text.hpp"
#include "simulation/time_features.hpp"

#include <cmath>
#include <numbers>

namespace cayspin::simulation::test {
namespace {

using cayspin::test::RandomPulses;

/// Returns a scene of one damped spin at equilibrium along z, with a pulse normal to it.
std::string pulse_scene(std::string const& integrator,
                        std::string const& across = "t>500 && t<501.5 ? 1.0 : 0") {
  return "system = { kind = 'llg', damping = 0.5 }\nlattice = { shape = [1] }\n"
         "field = { applied = [\"" +
         across + "\", \"0\", \"1.0\"] }\ninitial = { uniform = [0, 0, 1] }\nintegrator = { " +
         integrator + " }\n";
}

TEST(Pulses, AtRestAreNotMissed) {
  std::vector<double> const right{0.681299, 0.140225, 0.718449};
  for (auto const* const method : {"tsit5", "dp5", "bs3", "projected_dp5", "stiff2_adaptive"})
    for (auto const precision : precisions) {
      auto const scene =
          scene_of(pulse_scene(fmt::format("method = '{}', tolerance = 1e-4, end = 502", method)));
      EXPECT_LT(largest_distance(end_of(scene, precision), right), 3e-4) << method;
    }
}

TEST(Pulses, OfAnySmallPartOfARunAreFound) {
  for (double const width : {1e-9, 1e-6, 1e-3, 1.0}) {
    // A shorter pulse is stronger, so that its area is constant.
    auto const text = fmt::format("t>500.25 && t<{:.17g} ? {:.17g} : 0", 500.25 + width, 1 / width);
    auto const scene = scene_of(pulse_scene("method = 'tsit5', tolerance = 1e-6, end = 502", text));
    auto const features = make_plan(scene, Precision::double_precision).features;
    EXPECT_EQ(features->jumps, 2);
    ASSERT_TRUE(features->shortest);
    EXPECT_NEAR(features->shortest->length, width, 1e-3 * width + 1e-12);
    EXPECT_NEAR(features->shortest->time, 500.25, width + 1e-9);
    auto const end = end_of(scene);
    EXPECT_GT(std::hypot(end[0], end[1]), 0.1) << width;
  }
}

TEST(Pulses, RoundOffIsNone) {
  for (auto const* const text :
       {"sin(t)^2+cos(t)^2", "1+1e-10*sin(0.1*t)", "sqrt(sin(9*t)^2+cos(9*t)^2)",
        "0.001*cos(6e-6*t)", "1e-200*(sin(t)^2+cos(t)^2)"}) {
    SCOPED_TRACE(text);
    auto const scene = scene_of(pulse_scene("method = 'tsit5', tolerance = 1e-6, end = 20", text));
    auto const features = make_plan(scene, Precision::double_precision).features;
    EXPECT_EQ(features->jumps, 0);
    EXPECT_LE(features->bounds.size(), 8U);
  }
}

// The text holds neither the time of the pulse nor numbers whose sum or difference it is.
TEST(Pulses, AreFoundWhereTheTextDoesNotNameTheirTimes) {
  for (double const width : {0.02, 0.2})
    for (double const at : {17.3, 250.123, 500.3}) {
      SCOPED_TRACE(fmt::format("width {} at {}", width, at));
      auto const scene = scene_of(
          pulse_scene(fmt::format("method = 'tsit5', tolerance = 1e-6, end = {}", at + 1.5),
                      fmt::format("exp(0-((7*t-{})/{})^2)", 7 * at, 7 * width)));
      auto const features = make_plan(scene, Precision::double_precision).features;
      EXPECT_EQ(features->jumps, 0);
      ASSERT_TRUE(features->shortest);
      EXPECT_NEAR(features->shortest->length, 2 * std::sqrt(std::log(2.0)) * width, 0.01 * width);
      EXPECT_NEAR(features->shortest->time, at, 0.1 * width);
      // The pulse turns the spin by its area, and the turn decays for a time of 1.5.
      auto const end = end_of(scene);
      double const turn = std::sqrt(1.25 * std::numbers::pi) * width;
      EXPECT_NEAR(std::hypot(end[0], end[1]) / turn, std::exp(-0.5 * 1.5), 0.01);
    }
}

// In a constant field along z, m_z = tanh(damping * t). The small error with max_dt shows that no
// step was longer.
TEST(AdaptiveSteps, AreNoLongerThanTheScenesLongest) {
  auto const error = [](std::string const& keys) {
    auto const end =
        end_of(scene_of("system = { kind = 'llg', damping = 0.5 }\nlattice = { shape = [1] }\n"
                        "field = { applied = [0, 0, 1] }\ninitial = { uniform = [1, 0, 0] }\n"
                        "integrator = { method = 'bs3', tolerance = 1e-2, end = 5" +
                        keys + " }\n"));
    return std::abs(end[2] - std::tanh(0.5 * 5));
  };
  EXPECT_GT(error(""), 1e-6);
  EXPECT_LT(error(", max_dt = 0.01"), 2e-8);
}

TEST(Pulses, AreLookedForWhereTheFieldDependsOnTime) {
  auto const plan =
      make_plan(scene_of(pulse_scene("method = 'tsit5', tolerance = 1e-6, end = 502", "0.5")),
                Precision::double_precision);
  EXPECT_TRUE(plan.options.steps.bounds.empty());
  EXPECT_FALSE(plan.features->shortest);
}

// Errors are distances from a reference whose steps end at all corners of the field.
TEST(Pulses, RandomOnesAreFollowedToTheTolerance) {
  static constexpr char const* methods[] = {"tsit5", "dp5", "bs3", "projected_dp5",
                                            "stiff2_adaptive"};
  std::int64_t const count = setting("CAYSPIN_PULSES", 24);
  double worst = 0;
  for (std::int64_t number = 0; number < count; ++number) {
    RandomPulses const pulses(random_seed(), number);
    auto const* const method = methods[number % 5];
    double const tolerance = std::pow(10.0, -2.0 - static_cast<double>(number % 4));
    auto const scene = scene_of(fmt::format(
        "{}integrator = {{ method = '{}', tolerance = {:e}, end = {:.17g}{} }}\n", pulses.tables(),
        method, tolerance, pulses.end, number % 15 == 0 ? ", generator = 'orthogonal'" : ""));
    auto const exact = pulses.exact();
    double const error = largest_distance(end_of(scene), {exact[0], exact[1], exact[2]});
    worst = cayspin::test::larger(worst, error / tolerance);
    EXPECT_LT(error, 30 * tolerance) << number << '\n' << scene.text;
  }
  std::printf("    error over tolerance, of %ld fields: at most %.3g\n", static_cast<long>(count),
              worst);
}

TEST(Pulses, ThatEqualStepsMayMissAreWarnedOf) {
  std::int64_t const count = setting("CAYSPIN_PULSES", 24);
  std::int64_t warned = 0, silent = 0;
  for (std::int64_t number = 0; number < count; ++number) {
    RandomPulses const pulses(random_seed() + 1, number);
    double const shortest = pulses.shortest();
    if (!std::isfinite(shortest)) continue;
    for (double const share : {0.3, 3.0}) {
      auto const steps = static_cast<std::int64_t>(std::ceil(pulses.end / (share * shortest)));
      if (steps > 1'000'000'000) continue;
      auto const scene =
          scene_of(fmt::format("{}integrator = {{ method = 'rkmk4', dt = {:.17g}, steps = {} }}\n",
                               pulses.tables(), pulses.end / double(steps), steps));
      auto const plan = make_plan(scene, Precision::double_precision);
      auto const warning = dt_warning(plan, scene.units).value_or("");
      if (share > 1) {
        ++warned;
        EXPECT_NE(warning, "") << scene.text;
      } else if (!pulses.overlap()) {
        ++silent;
        EXPECT_EQ(warning.find("may miss"), std::string::npos) << warning << '\n' << scene.text;
      }
    }
  }
  // About three quarters of the fields have a pulse within the run, and no pulses that overlap.
  EXPECT_GE(warned, count / 3);
  EXPECT_GE(silent, count / 3);
}

TEST(Pulses, ThatAreShorterThanEqualStepsAreRefusedWhereTheSceneSaysSo) {
  auto const scene = [](std::string const& more) {
    return scene_of(pulse_scene("method = 'rkmk4', dt = 1.6, steps = 314" + more));
  };
  auto const warning = dt_warning(scene(""), make_plan(scene(""), Precision::double_precision));
  ASSERT_TRUE(warning);
  EXPECT_NE(warning->find("1.6 is longer than 1.5, a feature of field.applied at t = 500"),
            std::string::npos)
      << *warning;
  auto const refusing = scene(", refuse_unstable = true");
  EXPECT_THROW(dt_warning(refusing, make_plan(refusing, Precision::double_precision)),
               io::SceneError);
}

TEST(Pulses, ThatNoStepOfTheSceneMayResolveAreRefused) {
  expect_refused(
      [] {
        return scene_of(
            pulse_scene("method = 'tsit5', tolerance = 1e-4, min_dt = 2, max_dt = 3, end = 502"));
      },
      "2 is longer than a feature of field.applied at t = 500");
  for (char const* const frequency : {"1e5", "1e7"}) {
    auto const dense = [&](std::string const& more) {
      return scene_of(pulse_scene("method = 'tsit5', tolerance = 1e-4, end = 502" + more,
                                  fmt::format("sin({}*t)>0 ? 1 : 0", frequency)));
    };
    expect_refused([&] { return dense(""); }, "field.applied: changes too often");
    EXPECT_NO_THROW(make_plan(dense(", max_dt = 1e-8"), Precision::double_precision));
  }
}

TEST(Pulses, OfCurrentsAreFoundToo) {
  auto const scene = scene_of(
      "system = { kind = 'llg', damping = 0.1 }\nlattice = { shape = [4] }\n"
      "field = { exchange = 1.0, applied = [0, 0, 1] }\n"
      "torque.slonczewski = { damping_like = 't>77.7 && t<77.8 ? 0.3 : 0', polarization = [1, 0, "
      "0] }\n"
      "initial = { uniform = [0, 0, 1] }\n"
      "integrator = { method = 'tsit5', tolerance = 1e-5, end = 100 }\n");
  auto const plan = make_plan(scene, Precision::double_precision);
  ASSERT_TRUE(plan.features->shortest);
  EXPECT_EQ(plan.features->shortest->key, "torque.slonczewski");
  EXPECT_NEAR(plan.features->shortest->length, 0.1, 1e-6);
  EXPECT_EQ(plan.options.steps.bounds.size(), 2u);
}

// A run whose spins are at equilibrium does not end before a pulse.
TEST(Pulses, AreWaitedForByRunsThatEndAtRest) {
  auto const scene = scene_of(
      "system = { kind = 'llg', damping = 0.5 }\nlattice = { shape = [1] }\n"
      "field = { applied = ['t>500 && t<501.5 ? 1.0 : 0', '0', '1.0'] }\n"
      "initial = { uniform = [1, 0, 1] }\nintegrator = { method = 'tsit5', tolerance = 1e-6, "
      "dt = 0.5, end = 1000, until_torque = 1e-6 }\n");
  auto const run = SceneRun::open(scene, {});
  EXPECT_EQ(run->advance(scene.integrator.steps, {.until_torque = true}), Advanced::at_rest);
  EXPECT_GT(run->time(), 501.5);
  EXPECT_LE(run->time(), 600);  // the next check
}

// The last change of a field is unknown past the end of a scene.
TEST(Pulses, AreWaitedForPastTheEndOfTheScene) {
  for (std::string const end : {"steps = 0", "end = 50"}) {
    auto const scene = scene_of(fmt::format(
        "system = {{ kind = 'llg', damping = 0.5 }}\nlattice = {{ shape = [1] }}\n"
        "field = {{ applied = ['t > 60 ? 2 : 0', '0', '1.0'] }}\n"
        "initial = {{ uniform = [1, 0, 0.2] }}\nintegrator = {{ method = 'rkmk4', dt = 0.05, "
        "{}, until_torque = 1e-6 }}\n",
        end));
    auto const run = SceneRun::open(scene, {});
    Looks const looks{.period = 1, .until_torque = true, .run_end = 2000};
    EXPECT_EQ(run->advance(900, looks), Advanced::whole) << end;
    EXPECT_EQ(run->advance(1100, looks), Advanced::whole) << end;
    EXPECT_EQ(run->steps(), 2000) << end;
  }
}

// At rest the energy is -0.5, which is above the energy at the start, -0.78.
TEST(Pulses, ThatLowerAFieldDoNotKeepARunFromEndingAtRest) {
  auto const scene = scene_of(
      "system = { kind = 'llg', damping = 0.5 }\nlattice = { shape = [1] }\n"
      "field = { applied = ['0', '0', 't < 2 ? 4 : 0.5'] }\n"
      "initial = { uniform = [1, 0, 0.2] }\nintegrator = { method = 'rkmk4', dt = 0.05, "
      "end = 1000, until_torque = 1e-6 }\n");
  auto const run = SceneRun::open(scene, {});
  EXPECT_EQ(run->advance(scene.integrator.steps, {.until_torque = true}), Advanced::at_rest);
  EXPECT_LT(run->time(), 100);
  auto const m = spins_of(*run);
  EXPECT_LT(std::hypot(m[0], m[1]), 1e-5);
}

TEST(Pulses, OfOneSourceDoNotBoundTheStepForAnother) {
  auto const stable_dt = [](std::string const& sources) {
    return make_plan(llg_scene("0.1", "heun", 100,
                               "lattice = { shape = [4] }\ninitial = { uniform = [1, 0, 0] }\n"
                               "field = { sources = [" +
                                   sources + "] }"),
                     Precision::double_precision)
        .stable_dt;
  };
  std::string const constant = "{ profile = [0, 0, 10] }",
                    strong = "{ profile = [0, 0, 1e-6], time = '1e3*sin(t)' }";
  double const alone = stable_dt(constant);
  EXPECT_NEAR(stable_dt(constant + ", " + strong), alone, 1e-3 * alone);
  EXPECT_NEAR(stable_dt(strong + ", " + constant), alone, 1e-3 * alone);
}

TEST(Pulses, BitsOfARunInPiecesAreThoseOfOne) {
  auto const scene =
      scene_of(pulse_scene("method = 'dp5', tolerance = 1e-5, dt = 0.25, end = 502"));
  for (std::int64_t const cut : {1, 2000, 2001, 2003, 2006})
    expect_same_bits_after_a_break(scene, cut);
}

}  // namespace
}  // namespace cayspin::simulation::test
