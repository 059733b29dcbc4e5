// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Runs that fail after their start: status 2 or 3, one line, and a file marked as not complete.
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

class FailingRun : public ProgramTest {
 protected:
  Outcome run_chain(Arguments const& changes) const {
    return start(joined({"run", "chain.toml", "--quiet", "--overwrite"}, changes));
  }
};

TEST_F(FailingRun, EnergyThatRisesIsStatusThree) {
  // dt is above the method's stable limit of about 0.03.
  auto const outcome = run_chain(set("integrator={method='euler',dt=0.25,steps=1000}"));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(
      contains_all(behind_warning(outcome.errors), {"energy rose by", "last good frame is "}));
  auto const info = info_of("chain.h5");
  EXPECT_FALSE(info.complete);
  ASSERT_GE(info.frames, 1);
  for (std::size_t frame = 1; frame < info.frame_scalars.size(); ++frame)
    EXPECT_LT(info.frame_scalars[frame].energy, info.frame_scalars[frame - 1].energy);
}

// Above 4096 sites the energy is checked only in every tenth step, otherwise in every step.
TEST_F(FailingRun, AmongManySitesIsFoundInATenthStep) {
  auto const failing_step = [&](std::string const& sites) -> std::int64_t {
    auto const outcome = run_chain(set("lattice.shape=[" + sites + "]", "output.every=100000",
                                       "integrator={method='euler',dt=0.25,steps=1000}"));
    EXPECT_EQ(outcome.status, 3);
    auto const failure = behind_warning(outcome.errors);
    EXPECT_TRUE(contains_all(
        failure, {"energy rose by", "the last good frame is 0 in chain.h5 (step 0, t = 0)"}));
    std::string const before = "chain.toml: step ";
    auto const place = failure.find(before);
    EXPECT_NE(place, std::string::npos) << failure;
    return std::stoll(failure.substr(place + before.size()));
  };
  EXPECT_EQ(failing_step("4096"), 1);
  EXPECT_EQ(failing_step("4097"), 10);
}

TEST_F(FailingRun, EnergyGuardCanBeSwitchedOff) {
  auto const outcome =
      run_chain(set("integrator={method='euler',dt=0.25,steps=1000,energy_guard=false}"));
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(info_of("chain.h5").complete);
}

TEST_F(FailingRun, SpinsThatAreNotFiniteAreStatusThree) {
  auto const outcome =
      run_chain(set("integrator={method='classical_euler',dt=10.0,steps=1000}", "output.every=1"));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(contains(outcome.errors, "not finite"));
  auto const info = info_of("chain.h5");
  EXPECT_FALSE(info.complete);
  ASSERT_GE(info.frames, 1);
  EXPECT_TRUE(contains(outcome.errors, "frame is " + std::to_string(info.frames - 1) + " in"));
  for (double const component : last_spins("chain.h5")) EXPECT_TRUE(std::isfinite(component));
}

TEST_F(FailingRun, AppliedFieldThatIsNotFiniteOnTheWayIsStatusThree) {
  // The field is infinite at only one time, which the checks before the run do not find.
  auto const outcome = run_chain(set("integrator.dt=0.125", "integrator.steps=7", "output.every=1",
                                     "field.applied=[0,0,'t==0.125 ? 1/(t-0.125) : 0.1']"));
  EXPECT_EQ(outcome.status, 3);
  EXPECT_TRUE(is_one_line(outcome.errors));
  EXPECT_TRUE(contains(outcome.errors, ": field.applied: is not finite at t = 0.125; "));
  auto const info = info_of("chain.h5");
  EXPECT_FALSE(info.complete);
  EXPECT_GT(info.cost.wall_seconds, 0);  // the run closed its file
}

TEST_F(FailingRun, FullDiskIsStatusTwo) {
  expect_refused({"run", "chain.toml", "--quiet", "--set", "integrator.steps=100000", "--set",
                  "output.every=1", "--set", "integrator.dt=1e-4"},
                 "chain.h5: cannot write the file", {.file_limit = 1'500'000});
  auto const info = info_of("chain.h5");
  EXPECT_FALSE(info.complete);
  EXPECT_GT(info.frames, 0);
}

TEST_F(FailingRun, DiskFullAtTheStartLeavesNoFile) {
  expect_status(2, {"run", "chain.toml", "--quiet"}, {.file_limit = 20'000});
  EXPECT_FALSE(exists("chain.h5"));
}

TEST_F(FailingRun, ALatticeThatDoesNotFitIsRefusedWithItsNeed) {
  auto const outcome =
      expect_status(2, {"run", "chain.toml", "--set", "lattice={shape=[300000000,3000000]}"});
  EXPECT_TRUE(contains_all(outcome.errors, {"the run needs ", " of memory, ", "available"}));
}

TEST_F(FailingRun, AllocationThatFailsIsStatusTwo) {
  if (address_sanitizer) GTEST_SKIP() << "the sanitizer itself takes terabytes of address space";
  expect_status(
      2, {"run", "chain.toml", "--quiet", "--threads", "1", "--set", "lattice.shape=[2000000]"},
      {.memory_limit = 250'000'000});
  EXPECT_FALSE(exists("chain.h5"));
}

}  // namespace
}  // namespace cayspin::program::test
