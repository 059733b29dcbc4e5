// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs that end early: by a signal, or at equilibrium.
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

class EarlyEnd : public ProgramTest {
 protected:
  /// Runs the chain, and interrupts it shortly after `file` appears.
  Outcome interrupt(std::string const& file, Arguments const& more) const {
    return start(joined({"run", "chain.toml", "--quiet", "--output", file}, more),
                 {.interrupt_after = 0.2, .interrupt_when = in_folder(file)});
  }
};

TEST_F(EarlyEnd, InterruptLeavesAWholeFile) {
  auto const outcome = interrupt("chain.h5", set("integrator.steps=1000000000"));
  EXPECT_EQ(outcome.status, 130);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "interrupted"));
  auto const info = info_of("chain.h5");
  EXPECT_FALSE(info.complete);
  ASSERT_GT(info.frames, 0);
  EXPECT_TRUE(contains(outcome.errors,
                       "step " + std::to_string(info.frame_steps.back()) + " of 1000000000"));
  EXPECT_EQ(info.cost.evaluations, 4 * info.frame_steps.back());
  for (double const component : last_spins("chain.h5")) EXPECT_TRUE(std::isfinite(component));
}

// Steps are counted from the start of the first run, which this one continues.
TEST_F(EarlyEnd, InterruptAfterARestartNamesTheStepOfTheFile) {
  output_of({"run", "chain.toml", "--quiet", "--set", "integrator.steps=500"});
  auto const outcome =
      interrupt("on.h5", {"--set", "integrator.steps=1000000000", "--restart", "chain.h5"});
  EXPECT_EQ(outcome.status, 130);
  auto const step = std::to_string(info_of("on.h5").frame_steps.back());
  EXPECT_TRUE(contains(outcome.errors, "interrupted after step " + step + " of 1000000000; "));
  EXPECT_TRUE(contains(outcome.errors, "on.h5 (step " + step + ", t = "));
}

// A scene without dt can be interrupted, too.
TEST_F(EarlyEnd, InterruptEndsAdaptiveSteps) {
  auto const outcome =
      interrupt("chain.h5", set("integrator={method='tsit5',tolerance=1e-8,end=2e5}",
                                "output.checkpoint_every=0", "output.every=128"));
  EXPECT_EQ(outcome.status, 130) << outcome.errors;
  auto const info = info_of("chain.h5");
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 2);
  EXPECT_GT(info.frame_times.back(), 0);
  EXPECT_LT(info.frame_times.back(), 2e5);
}

TEST_F(EarlyEnd, RestEndsARun) {
  auto const info =
      run(macrospin_scene(), set("integrator.end=1000.0", "integrator.until_torque=1e-6"));
  // sin(theta) starts at about 1 and falls as exp(-damping * t).
  EXPECT_GT(info.frame_times.back(), std::log(1e6) / 0.5 - 2);
  EXPECT_LT(info.frame_times.back(), std::log(1e6) / 0.5 + 4);
  EXPECT_EQ(info.frames, 2);
  auto const m = last_spins("out.h5");
  EXPECT_LT(std::hypot(m[0], m[1]), 1e-6);
  EXPECT_EQ(info.cost.evaluations, 4 * info.frame_steps.back());
}

TEST_F(EarlyEnd, RestAtTheTopOfTheEnergyDoesNotEndARun) {
  auto const info =
      run(macrospin_scene(), set("initial.uniform=[0,0,-1]", "integrator.until_torque=1e-6"));
  EXPECT_EQ(info.frame_steps.back(), 50);
}

TEST_F(EarlyEnd, NoStepsIsOneFrame) {
  auto const info = run(macrospin_scene(), set("integrator={method='euler',dt=0.1,steps=0}"));
  EXPECT_EQ(info.frames, 1);
  EXPECT_EQ(info.samples, 1);
  EXPECT_EQ(info.cost.evaluations, 0);
}

}  // namespace
}  // namespace cayspin::program::test
