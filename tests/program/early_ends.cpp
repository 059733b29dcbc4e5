// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs that end before their end: by a signal, or at rest.
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

using EarlyEnd = ProgramTest;

TEST_F(EarlyEnd, InterruptLeavesAWholeFile) {
  write("chain.toml", chain_scene());
  auto const outcome =
      start({"run", "chain.toml", "--quiet", "--set", "integrator.steps=1000000000"},
            {.interrupt_after = 0.2, .interrupt_when = in_folder("chain.h5")});
  EXPECT_EQ(outcome.status, 130);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "interrupted"));
  auto const info = io::read_info(in_folder("chain.h5"));
  EXPECT_FALSE(info.complete);
  ASSERT_GT(info.frames, 0);
  EXPECT_TRUE(contains(outcome.errors,
                       "step " + std::to_string(info.frame_steps.back()) + " of 1000000000"));
  EXPECT_EQ(info.cost.evaluations, 4 * info.frame_steps.back());
  for (double const component : last_spins("chain.h5")) EXPECT_TRUE(std::isfinite(component));
}

// Steps are counted from the start of the run that it goes on from.
TEST_F(EarlyEnd, InterruptAfterARestartNamesTheStepOfTheFile) {
  write("chain.toml", chain_scene());
  EXPECT_EQ(start({"run", "chain.toml", "--quiet", "--set", "integrator.steps=500"}).status, 0);
  auto const outcome =
      start({"run", "chain.toml", "--quiet", "--set", "integrator.steps=1000000000", "--restart",
             "chain.h5", "--output", "on.h5"},
            {.interrupt_after = 0.2, .interrupt_when = in_folder("on.h5")});
  EXPECT_EQ(outcome.status, 130);
  auto const step = std::to_string(io::read_info(in_folder("on.h5")).frame_steps.back());
  EXPECT_TRUE(contains(outcome.errors, "interrupted after step " + step + " of 1000000000; "));
  EXPECT_TRUE(contains(outcome.errors, "on.h5 (step " + step + ", t = "));
}

// Without a dt of the scene, too.
TEST_F(EarlyEnd, InterruptEndsAdaptiveSteps) {
  write("chain.toml", chain_scene());
  auto const outcome = start({"run", "chain.toml", "--quiet", "--set",
                              "integrator={method='tsit5',tolerance=1e-8,end=2e5}", "--set",
                              "output.checkpoint_every=0", "--set", "output.every=128"},
                             {.interrupt_after = 0.2, .interrupt_when = in_folder("chain.h5")});
  EXPECT_EQ(outcome.status, 130) << outcome.errors;
  auto const info = io::read_info(in_folder("chain.h5"));
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 2);
  EXPECT_GT(info.frame_times.back(), 0);
  EXPECT_LT(info.frame_times.back(), 2e5);
}

TEST_F(EarlyEnd, RestEndsARun) {
  auto const info = run(macrospin_scene(), {"--set", "integrator.end=1000.0", "--set",
                                            "integrator.until_torque=1e-6"});
  // sin(theta) falls as exp(-damping t), from about 1.
  EXPECT_GT(info.frame_times.back(), std::log(1e6) / 0.5 - 2);
  EXPECT_LT(info.frame_times.back(), std::log(1e6) / 0.5 + 4);
  EXPECT_EQ(info.frames, 2);
  auto const m = last_spins("out.h5");
  EXPECT_LT(std::hypot(m[0], m[1]), 1e-6);
  EXPECT_EQ(info.cost.evaluations, 4 * info.frame_steps.back());
}

TEST_F(EarlyEnd, RestAtTheTopOfTheEnergyDoesNotEndARun) {
  auto const info = run(macrospin_scene(), {"--set", "initial.uniform=[0,0,-1]", "--set",
                                            "integrator.until_torque=1e-6"});
  EXPECT_EQ(info.frame_steps.back(), 50);
}

TEST_F(EarlyEnd, NoStepsIsOneFrame) {
  auto const info = run(macrospin_scene(), {"--set", "integrator={method='euler',dt=0.1,steps=0}"});
  EXPECT_EQ(info.frames, 1);
  EXPECT_EQ(info.samples, 1);
  EXPECT_EQ(info.cost.evaluations, 0);
}

}  // namespace
}  // namespace cayspin::program::test
