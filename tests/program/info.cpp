// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin info.
#include "program_test.hpp"

namespace cayspin::program::test {
namespace {

using Info = ProgramTest;

TEST_F(Info, SaysWhatAFileHolds) {
  run(chain_scene());
  EXPECT_TRUE(
      contains_all(output_of({"info", "out.h5"}),
                   {"complete     yes", "20 x 3 x 1 sites, double precision", "frames       4",
                    "step 25, t = 0.5", "100 evaluations", "random = { seed = 3 }"}));
}

TEST_F(Info, SaysThatAFileIsNotComplete) {
  run_into("out.h5", chain_scene(),
           set("integrator.method='classical_euler'", "integrator.dt=100.0"));
  EXPECT_TRUE(contains(output_of({"info", "out.h5"}), "complete     no"));
}

}  // namespace
}  // namespace cayspin::program::test
