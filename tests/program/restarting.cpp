// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// --restart: a run that goes on from a file is the run without a break.
#include "program_test.hpp"

namespace cayspin::program::test {
namespace {

class Restarting : public ProgramTest {
 protected:
  /// The first `steps` of the scene's 25, in `file`.
  void run_to(char const* steps, char const* file, Arguments more = {}) const {
    Arguments arguments{
        "run",   write("scene.toml", chain_scene()),      "--quiet", "--output", file,
        "--set", std::string("integrator.steps=") + steps};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto const outcome = start(arguments);
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    EXPECT_EQ(outcome.errors, "");
  }

  void expect_refused(Arguments const& more, std::string const& part,
                      std::string const& output = "second.h5") const {
    Arguments arguments{
        "run",     write("scene.toml", chain_scene()), "--quiet", "--output", output, "--restart",
        "first.h5"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto const outcome = start(arguments);
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(is_one_line(outcome.errors)) << outcome.errors;
    EXPECT_TRUE(contains(outcome.errors, part));
    EXPECT_FALSE(std::filesystem::exists(in_folder("second.h5")));
  }
};

TEST_F(Restarting, GivesTheBitsOfARunWithoutABreak) {
  for (std::string const precision : {"double", "single"}) {
    Arguments const same{"--precision", precision, "--overwrite", "--set",
                         "field.applied=['0.3*cos(7*t)','0.1','0.2']"};
    run_to("25", "whole.h5", same);
    run_to("12", "first.h5", same);
    auto more = same;
    more.insert(more.end(), {"--restart", "first.h5"});
    run_to("25", "second.h5", more);
    EXPECT_EQ(last_spins("second.h5"), last_spins("whole.h5"));
    auto const info = io::read_info(in_folder("second.h5"));
    EXPECT_TRUE(info.complete);
    EXPECT_EQ(info.frame_steps, (std::vector<std::int64_t>{12, 20, 25}));
    EXPECT_EQ(info.frame_times.back(), io::read_info(in_folder("whole.h5")).frame_times.back());
    EXPECT_EQ(info.cost.evaluations, 13 * 4);
  }
}

TEST_F(Restarting, IsRefusedForAnotherStateThanTheScenes) {
  run_to("12", "first.h5");
  expect_refused({"--set", "lattice.shape=[20,4]"}, "its lattice is 20 x 3 x 1");
  expect_refused({"--precision", "single"}, "accepted: --precision double");
  expect_refused({"--set", "integrator.dt=0.01"}, "its step 12 is at t = 0.24");
  expect_refused({"--set", "integrator.steps=12"}, "it ends at step 12, the scene at step 12");
  auto const before = last_spins("first.h5");
  expect_refused({"--overwrite"}, "another file for --output", "first.h5");
  EXPECT_EQ(last_spins("first.h5"), before);
  std::filesystem::remove(in_folder("first.h5"));
  expect_refused({}, "first.h5");
}

}  // namespace
}  // namespace cayspin::program::test
