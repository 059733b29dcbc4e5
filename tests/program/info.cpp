// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin info.
#include "program_test.hpp"

namespace cayspin::program::test {
namespace {

using Info = ProgramTest;

TEST_F(Info, SaysWhatAFileHolds) {
  run(chain_scene());
  auto const outcome = start({"info", "out.h5"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_EQ(outcome.errors, "");
  for (char const* part :
       {"complete     yes", "20 x 3 x 1 sites, double precision", "frames       4",
        "step 25, t = 0.5", "100 evaluations", "random = { seed = 3 }"})
    EXPECT_TRUE(contains(outcome.output, part));
}

TEST_F(Info, SaysThatAFileIsNotComplete) {
  write("chain.toml", chain_scene());
  start({"run", "chain.toml", "--quiet", "--set", "integrator.method='classical_euler'", "--set",
         "integrator.dt=100.0"});
  auto const outcome = start({"info", "chain.h5"});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.output, "complete     no"));
}

}  // namespace
}  // namespace cayspin::program::test
