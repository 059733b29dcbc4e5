// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Successful runs: the file, messages and warnings.
#include "../support/larger.hpp"
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

using Running = ProgramTest;
using Steps = std::vector<std::int64_t>;

TEST_F(Running, FramesAndSamplesAreWhereTheSceneAsks) {
  auto const info = run(chain_scene(), set("output.scalars_every=2"));
  EXPECT_EQ(info.frame_steps, (Steps{0, 10, 20, 25}));
  EXPECT_EQ(info.samples, 14);  // 0, 2, .., 24 and 25
  ASSERT_EQ(info.frame_times.size(), 4u);
  for (std::size_t frame = 0; frame < 4; ++frame)
    EXPECT_EQ(info.frame_times[frame], static_cast<double>(info.frame_steps[frame]) * 0.02);
  EXPECT_EQ(read_dataset("out.h5", "/scalars/energy").extents, Steps{14});
  EXPECT_EQ(read_dataset("out.h5", "/scalars/magnetization").extents, (Steps{14, 3}));
  EXPECT_EQ(read_dataset("out.h5", "/spins").extents, (Steps{4, 1, 3, 20, 3}));
}

TEST_F(Running, FramesDefaultToFirstAndLast) {
  EXPECT_EQ(run(macrospin_scene()).frame_steps, (Steps{0, 50}));
}

TEST_F(Running, AttributesSayWhatRan) {
  auto const info =
      run(chain_scene(), {"--space", another_space, "--threads", "1", "--precision", "single"});
  EXPECT_EQ(info.format, 1);
  EXPECT_EQ(info.header.scene_text, chain_scene());
  EXPECT_EQ(info.header.space, another_space);
  EXPECT_EQ(info.header.threads, 1);
  EXPECT_EQ(info.header.precision, "single");
  EXPECT_FALSE(info.header.cayspin_version.empty());
  EXPECT_FALSE(info.header.git_commit.empty());
  EXPECT_FALSE(info.header.kokkos_version.empty());
  EXPECT_EQ(info.cost.evaluations, 100);
  EXPECT_GT(info.cost.step_seconds, 0);
  EXPECT_GT(info.cost.wall_seconds, info.cost.step_seconds);
}

TEST_F(Running, OverridesReachTheSceneText) {
  auto const info = run(chain_scene(), set("integrator.steps=5"));
  EXPECT_TRUE(contains(info.header.scene_text, "steps = 5"));
  EXPECT_EQ(info.frame_steps, (Steps{0, 5}));
}

TEST_F(Running, ScalarsAreThoseOfTheFrames) {
  auto const info = run(chain_scene());
  auto const spins = read_dataset("out.h5", "/spins").values;
  for (std::size_t frame = 0; frame < 4; ++frame) {
    double mean[3] = {0, 0, 0}, defect = 0;
    for (std::size_t site = 0; site < 60; ++site) {
      double const* const m = &spins[3 * (60 * frame + site)];
      for (int c = 0; c < 3; ++c) mean[c] += m[c] / 60;
      defect = cayspin::test::larger(defect, std::abs(std::hypot(m[0], m[1], m[2]) - 1));
    }
    for (std::size_t c = 0; c < 3; ++c)
      EXPECT_NEAR(info.frame_scalars[frame].magnetization[c], mean[c], 1e-15);
    EXPECT_NEAR(info.frame_scalars[frame].norm_defect, defect, 3e-16);
    EXPECT_LT(defect, 1e-14);
    if (frame > 0) {
      EXPECT_LT(info.frame_scalars[frame].energy, info.frame_scalars[frame - 1].energy);
    }
  }
}

TEST_F(Running, EnergyOfOneSpinIsTheFormula) {
  auto const info = run(macrospin_scene(), set("field.anisotropy={constant=0.7,axis=[1,0,1]}",
                                               "field.slab_demag={normal=[0,0,1],strength=0.4}",
                                               "field.mu0=2.0", "initial.uniform=[0.6,0,0.8]"));
  double const anisotropy = -0.35 * 1.4 * 1.4 / 2, zeeman = -2 * 0.8, demag = 0.4 * 0.64;
  EXPECT_NEAR(info.frame_scalars[0].energy, anisotropy + zeeman + demag, 1e-15);
}

// Arithmetic on denormal numbers is ten times slower, and a run near equilibrium would be full of
// them.
TEST_F(Running, ComponentsThatDecayEndAtZero) {
  for (std::string const threads : {"1", "2"}) {
    run(macrospin_scene(),
        {"--precision", "single", "--threads", threads, "--set", "lattice.shape=[20000]", "--set",
         "integrator={method='rkmk4',dt=1.0,end=190.0}"});
    for (double const component : last_spins("out.h5"))
      ASSERT_TRUE(component == 0 || std::isnormal(static_cast<float>(component))) << component;
  }
}

TEST_F(Running, ProgressIsPlainLinesWithoutATerminal) {
  auto const output = output_of({"run", "chain.toml"});
  EXPECT_TRUE(contains(output, "chain.h5: 25 steps, 4 frames"));
  EXPECT_FALSE(contains(output, "\r"));
}

TEST_F(Running, DtAboveTheStableOneIsWarnedOf) {
  auto const outcome = start({"run", "spin.toml", "--quiet", "--output", "out.h5", "--set",
                              "integrator.method='projected_euler'", "--set", "system.damping=0"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "warning: spin.toml:12: integrator.dt"));
}

// projected_rk8 is stable up to dt = 6 for this spin, but shorter steps already turn it too far,
// and the program warns of them. On a chain the exchange limits dt, and there is no warning below
// the stable dt.
TEST_F(Running, TurnsBelowTheStableDtAreWarnedOfUnlessTheyAreThoseOfExchange) {
  auto const warning = [&](char const* dt, Arguments const& more) {
    auto const method = std::string("integrator={method='projected_rk8',steps=4,dt=") + dt + "}";
    return run_into("out.h5", macrospin_scene(), joined(set(method, "system.damping=0.02"), more))
        .errors;
  };
  EXPECT_TRUE(contains(warning("3.5", {}), "turns spins by up to 3.5"));
  EXPECT_EQ(warning("2.5", {}), "");
  Arguments const chain = set("field.exchange=1", "lattice={shape=[16]}");
  EXPECT_EQ(warning("0.9", chain), "");
  EXPECT_TRUE(contains(warning("1.5", chain), "is above the stable 1.2"));
}

#if !defined(CAYSPIN_HOST_DEVICE)
TEST_F(Running, ASerialSpaceWithMoreThreadsIsRefused) {
  expect_refused({"run", "chain.toml", "--space", "serial", "--threads", "2"},
                 "--threads 2: --space serial has one thread; accepted: 1");
}
#endif

}  // namespace
}  // namespace cayspin::program::test
