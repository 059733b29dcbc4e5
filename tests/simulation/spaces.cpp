// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The space "serial" is the host's space with one thread.
#include "random_run.hpp"
#include "scenes_of_text.hpp"
#include "simulation/failure.hpp"

#include <cstdlib>

namespace cayspin::simulation::test {
namespace {

#if !defined(CAYSPIN_HOST_DEVICE)
io::Scene chain() { return llg_scene("0.1", "rkmk4", 1, chain_of_nine); }

[[noreturn]] void exit_with_threads_of_serial() {
  int threads = 0;
  {
    auto const run = SceneRun::open(chain(), {.space = "serial"});
    if (run->space() == "serial") threads = run->threads();
  }
  std::exit(threads);
}

TEST(SerialSpace, StartsKokkosWithOneThread) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // in a process that has not started Kokkos
  EXPECT_EXIT(exit_with_threads_of_serial(), testing::ExitedWithCode(1), "");
}

TEST(SerialSpace, IsRefusedWhereThereAreMoreThreads) {
  auto const run = SceneRun::open(chain(), {});
  if (run->threads() == 1) {
    EXPECT_EQ(SceneRun::open(chain(), {.space = "serial"})->threads(), 1);
    return;
  }
  try {
    SceneRun::open(chain(), {.space = "serial"});
    ADD_FAILURE() << "one thread of " << run->threads();
  } catch (UsageError const& error) {
    EXPECT_EQ(error.what(), fmt::format("space serial: Kokkos runs with {} threads; accepted: one "
                                        "thread",
                                        run->threads()));
  }
}
#endif

}  // namespace
}  // namespace cayspin::simulation::test
