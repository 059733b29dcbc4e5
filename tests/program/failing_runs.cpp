// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs that fail on their way: status 2 or 3, one line, and a file that does not look whole.
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

using FailingRun = ProgramTest;

TEST_F(FailingRun, EnergyThatRisesIsStatusThree) {
  write("chain.toml", chain_scene());
  // Above the limit of the method, which is about 0.03.
  auto const outcome = start({"run", "chain.toml", "--quiet", "--set", "integrator.method='euler'",
                              "--set", "integrator.dt=0.25", "--set", "integrator.steps=1000"});
  EXPECT_EQ(outcome.status, 3);
  auto const warning_end = outcome.errors.find('\n') + 1;
  auto const warning = outcome.errors.substr(0, warning_end);
  auto const failure = outcome.errors.substr(warning_end);
  EXPECT_TRUE(contains(warning, "warning: ") && contains(warning, "integrator.dt"));
  EXPECT_TRUE(is_one_line(failure));
  EXPECT_TRUE(contains(failure, "energy rose by"));
  EXPECT_TRUE(contains(failure, "last good frame is "));
  auto const info = io::read_info(in_folder("chain.h5"));
  EXPECT_FALSE(info.complete);
  ASSERT_GE(info.frames, 1);
  for (std::size_t frame = 1; frame < info.frame_scalars.size(); ++frame)
    EXPECT_LT(info.frame_scalars[frame].energy, info.frame_scalars[frame - 1].energy);
}

TEST_F(FailingRun, EnergyGuardCanBeSwitchedOff) {
  write("chain.toml", chain_scene());
  auto const outcome = start({"run", "chain.toml", "--quiet", "--set", "integrator.method='euler'",
                              "--set", "integrator.dt=0.25", "--set", "integrator.steps=1000",
                              "--set", "integrator.energy_guard=false"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(io::read_info(in_folder("chain.h5")).complete);
}

TEST_F(FailingRun, SpinsThatAreNotFiniteAreStatusThree) {
  write("chain.toml", chain_scene());
  auto const outcome = start({"run", "chain.toml", "--quiet", "--set",
                              "integrator.method='classical_euler'", "--set", "integrator.dt=10.0",
                              "--set", "integrator.steps=1000", "--set", "output.every=1"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(contains(outcome.errors, "not finite"));
  auto const info = io::read_info(in_folder("chain.h5"));
  EXPECT_FALSE(info.complete);
  ASSERT_GE(info.frames, 1);
  EXPECT_TRUE(contains(outcome.errors, "frame is " + std::to_string(info.frames - 1) + " in"));
  for (double const component : last_spins("chain.h5")) EXPECT_TRUE(std::isfinite(component));
}

TEST_F(FailingRun, AppliedFieldThatIsNotFiniteOnTheWayIsStatusThree) {
  write("chain.toml", chain_scene());
  // The pole is a time of this run, but not one of those that are tried beforehand.
  auto const outcome = start({"run", "chain.toml", "--quiet", "--set", "integrator.dt=0.125",
                              "--set", "integrator.steps=7", "--set", "output.every=1", "--set",
                              "field.applied=[0,0,'abs(t-0.125) < 1e-6 ? 1/(t-0.125) : 0.1']"});
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "field.applied, t = 0.125"));
  EXPECT_FALSE(io::read_info(in_folder("chain.h5")).complete);
}

TEST_F(FailingRun, FullDiskIsStatusTwo) {
  write("chain.toml", chain_scene());
  auto const outcome = start({"run", "chain.toml", "--quiet", "--set", "integrator.steps=100000",
                              "--set", "output.every=1", "--set", "integrator.dt=1e-4"},
                             {.file_limit = 1'500'000});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, "chain.h5: cannot write the file"));
  auto const info = io::read_info(in_folder("chain.h5"));
  EXPECT_FALSE(info.complete);
  EXPECT_GT(info.frames, 0);
}

TEST_F(FailingRun, DiskFullAtTheStartLeavesNoFile) {
  write("chain.toml", chain_scene());
  auto const outcome = start({"run", "chain.toml", "--quiet"}, {.file_limit = 20'000});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_FALSE(std::filesystem::exists(in_folder("chain.h5")));
}

TEST_F(FailingRun, AllocationThatFailsIsStatusTwo) {
  if (address_sanitizer) GTEST_SKIP() << "the sanitizer itself takes terabytes of address space";
  write("chain.toml", chain_scene());
  auto const outcome =
      start({"run", "chain.toml", "--quiet", "--threads", "1", "--set", "lattice.shape=[2000000]"},
            {.memory_limit = 250'000'000});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_FALSE(std::filesystem::exists(in_folder("chain.h5")));
}

}  // namespace
}  // namespace cayspin::program::test
