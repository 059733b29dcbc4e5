// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// States that the guard of a run accepts and refuses: numbers just below and just above its limits.
#include "simulation/guard.hpp"

#include "io/scene.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace cayspin::simulation {
namespace {

io::Scene scene(double damping, std::string const& method = "rkmk4", std::string const& more = "",
                std::string const& applied = "[0, 0, 1]") {
  return io::parse_scene("[system]\nkind = \"llg\"\ndamping = " + std::to_string(damping) +
                             "\n[lattice]\nshape = [4]\n[field]\napplied = " + applied +
                             "\n[initial]\nuniform = [1, 0, 0]\n[integrator]\nmethod = \"" +
                             method + "\"\ndt = 0.125\nsteps = 8\n" + more,
                         "scene.toml");
}

Step at(std::int64_t number) { return {number, 0.125 * static_cast<double>(number), 0.125, false}; }

template <class Real>
class GuardIn : public ::testing::Test {
 protected:
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();
  Guard damped{scene(0.5), epsilon};

  void expect_limit_of_length(std::int64_t step, double limit) {
    EXPECT_FALSE(damped.judge(at(step), {0, 0}, limit)) << step;
    auto const failure = damped.judge(at(step), {0, 0}, std::nextafter(limit, 1));
    ASSERT_TRUE(failure) << step;
    EXPECT_TRUE(failure->starts_with("step " + std::to_string(step) + ", t = "));
    EXPECT_NE(failure->find("a spin left the sphere"), std::string::npos) << *failure;
  }
};
using Precisions = ::testing::Types<float, double>;
TYPED_TEST_SUITE(GuardIn, Precisions);

// The limit of | |m| - 1 | is 64 * epsilon at the start. Later it is 64 * epsilon * max(steps,
// 1e6), but at most 0.01.
TYPED_TEST(GuardIn, LengthsMayBeOffByRoundOff) {
  double const of_a_step = 64 * std::numeric_limits<TypeParam>::epsilon();
  this->expect_limit_of_length(0, of_a_step);
  this->expect_limit_of_length(1, std::min(0.01, 1e6 * of_a_step));
  this->expect_limit_of_length(1'000'000, std::min(0.01, 1e6 * of_a_step));
  this->expect_limit_of_length(3'000'000, std::min(0.01, 3e6 * of_a_step));
  this->expect_limit_of_length(1'000'000'000'000, 0.01);
}

TYPED_TEST(GuardIn, EnergiesMayRiseByRoundOff) {
  double const rise = 5 * 64 * std::numeric_limits<TypeParam>::epsilon();  // at a magnitude of 5
  EXPECT_FALSE(this->damped.judge(at(0), {0, 5}, 0));
  EXPECT_FALSE(this->damped.judge(at(1), {rise, 5}, 0));
  EXPECT_FALSE(this->damped.judge(at(2), {0, 5}, 0));
  EXPECT_EQ(this->damped.first_energy(), 0);
  auto const failure = this->damped.judge(at(7), {std::nextafter(rise, 1), 5}, 0);
  ASSERT_TRUE(failure);
  EXPECT_TRUE(failure->starts_with("step 7, t = 0.875: the energy rose by ")) << *failure;
  EXPECT_NE(failure->find("from 0 at step 2"), std::string::npos) << *failure;
}

// The limit follows the current magnitude, and each rise is measured from the energy of the
// previous call.
TYPED_TEST(GuardIn, SmallRisesDoNotAddUp) {
  double const rise = 60 * std::numeric_limits<TypeParam>::epsilon();
  double energy = 1;
  for (int step = 0; step < 20; ++step, energy += rise)
    EXPECT_FALSE(this->damped.judge(at(step), {energy, 1}, 0)) << step;
  EXPECT_TRUE(this->damped.judge(at(20), {energy, 0.5}, 0));
}

// Steps that are chosen by a tolerance have errors of that size, so that at equilibrium the energy
// fluctuates by up to the tolerance times the energy's magnitude.
TYPED_TEST(GuardIn, EnergiesMayRiseByTheToleranceOfTheSteps) {
  double const rise = 5 * 0.0078125;
  Guard guard(scene(0.5, "tsit5", "tolerance = 0.0078125\n"),
              std::numeric_limits<TypeParam>::epsilon());
  EXPECT_FALSE(guard.judge(at(0), {0, 5}, 0));
  EXPECT_FALSE(guard.judge(at(1), {rise, 5}, 0));
  EXPECT_FALSE(guard.judge(at(2), {0, 5}, 0));
  EXPECT_TRUE(guard.judge(at(3), {std::nextafter(rise, 1), 5}, 0));
}

TYPED_TEST(GuardIn, FallsOfAnySizePass) {
  EXPECT_FALSE(this->damped.judge(at(0), {1e6, 1}, 0));
  EXPECT_FALSE(this->damped.judge(at(1), {-1e6, 1}, 0));
}

TYPED_TEST(GuardIn, NumbersThatAreNotFiniteFailAtAnyStep) {
  double const epsilon = std::numeric_limits<TypeParam>::epsilon();
  for (auto const& guarded : {scene(0.5), scene(0), scene(0.5, "classical_rk4")})
    for (double const wrong : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
      Guard guard(guarded, epsilon);
      EXPECT_EQ(guard.judge(at(2), {0, 0}, wrong),
                "step 2, t = 0.25: a spin is not finite any more");
      EXPECT_EQ(guard.judge(at(3), {wrong, 0}, 0),
                "step 3, t = 0.375: the energy is not finite any more");
    }
}

TYPED_TEST(GuardIn, LengthsOfBaselinesAreNotLookedAt) {
  Guard guard(scene(0.5, "classical_rk4"), std::numeric_limits<TypeParam>::epsilon());
  EXPECT_FALSE(guard.judge(at(0), {0, 0}, 0.5));
  EXPECT_FALSE(guard.judge(at(1), {9, 0}, 0.5));
}

bool must_fall(io::Scene const& scene) { return energy_must_fall(scene, all_are_damped(scene)); }

TEST(Guard, EnergiesAreHeldWhereDampingLetsThemOnlyFall) {
  EXPECT_TRUE(must_fall(scene(0.5)));
  EXPECT_FALSE(must_fall(scene(0)));
  auto of_sites = scene(0);
  of_sites.system.dampings.expression = "0.1";
  EXPECT_TRUE(must_fall(of_sites));
  // The energy may rise where only precession moves a spin.
  of_sites.system.dampings.expression = "i";
  EXPECT_FALSE(must_fall(of_sites));
  auto without_motion = of_sites;
  without_motion.lattice.frozen.expression = "i == 0";
  EXPECT_TRUE(must_fall(without_motion));
  without_motion = of_sites;
  without_motion.lattice.occupied.expression = "i > 0";
  EXPECT_TRUE(must_fall(without_motion));
  EXPECT_FALSE(must_fall(scene(0.5, "classical_rk4")));
  EXPECT_FALSE(must_fall(scene(0.5, "rkmk4", "energy_guard = false\n")));
  EXPECT_FALSE(must_fall(scene(0.5, "rkmk4", "", "[0, 0, \"cos(t)\"]")));
  EXPECT_FALSE(must_fall(io::parse_scene(
      "[system]\nkind = \"rigid_body\"\ninertia = [1, 2, 3]\n[lattice]\nshape = [4]\n[initial]\n"
      "uniform = [1, 0, 0]\n[integrator]\nmethod = \"rkmk4\"\ndt = 0.125\nsteps = 8\n",
      "scene.toml")));
  // At a temperature above 0, the energy may rise.
  auto warm = scene(0.5);
  warm.thermal.emplace().temperature = 0.1;
  EXPECT_FALSE(must_fall(warm));
  warm.thermal->temperature = 0;
  EXPECT_TRUE(must_fall(warm));
  Guard undamped(scene(0), std::numeric_limits<double>::epsilon());
  EXPECT_FALSE(undamped.judge(at(0), {0, 1}, 0));
  EXPECT_FALSE(undamped.judge(at(1), {1, 1}, 0));
}

TEST(Guard, LooksAtFewSitesInEveryStepAndAtManyInEveryTenth) {
  EXPECT_EQ(Guard::period_of(1), 1);
  EXPECT_EQ(Guard::period_of(4096), 1);
  EXPECT_EQ(Guard::period_of(4097), 10);
  auto const wide = [](int sites) {
    auto chain = scene(0.5);
    chain.lattice.shape[0] = sites;
    return Guard(chain, 1e-16);
  };
  for (int step = 0; step < 25; ++step) {
    EXPECT_TRUE(wide(4096).due(at(step)));
    EXPECT_EQ(wide(4097).due(at(step)), step % 10 == 0) << step;
  }
}

}  // namespace
}  // namespace cayspin::simulation
