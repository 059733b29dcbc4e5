// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin watch: a run followed by its file, which it does not notice.
#include "../scene/hdf5_file.hpp"
#include "program_test.hpp"

#include <chrono>
#include <csignal>
#include <fstream>

namespace cayspin::program::test {
namespace {

namespace fs = std::filesystem;

class Watching : public ProgramTest {
 protected:
  pid_t begin_run(std::string const& steps) const {
    return begin({"run", "chain.toml", "--quiet", "--overwrite", "--threads", "1", "--output",
                  "run.h5", "--set", "integrator.steps=" + steps, "--set", "output.every=50000",
                  "--set", "output.scalars_every=1000"});
  }

  std::string look() const { return output_of({"watch", "run.h5", "--once"}); }

  /// The step that a look tells, or -1.
  static std::int64_t step(std::string const& output) {
    auto const place = output.find("step ");
    return place == output.npos ? -1 : std::stoll(output.substr(place + 5));
  }
};

TEST_F(Watching, EndsWithTheRunAndChangesNoBit) {
  auto const process = begin_run("200000");
  ASSERT_TRUE(eventually([&] { return exists("run.h5"); }));
  auto const output = output_of({"watch", "run.h5"});
  EXPECT_EQ(end(process, 0), 0);
  EXPECT_TRUE(contains(output, "step 200000 of 200000 (100.0 %), t = 4000: energy "));
  EXPECT_TRUE(output.ends_with("complete\n")) << output;

  auto const watched = read_dataset("run.h5", "/spins").values;
  EXPECT_EQ(end(begin_run("200000"), 0), 0);
  EXPECT_EQ(read_dataset("run.h5", "/spins").values, watched);
  EXPECT_EQ(watched.size(), 5u * 60 * 3);
}

TEST_F(Watching, SeesARunMoveOnAndEndEarly) {
  auto const process = begin_run("1000000000");
  std::string output;
  ASSERT_TRUE(eventually([&] { return exists("run.h5") && step(output = look()) > 0; }));
  EXPECT_TRUE(contains(output, "under way"));
  EXPECT_TRUE(contains(output, "of 1000000000"));
  EXPECT_TRUE(contains(output, " left"));
  auto const first = step(output);
  EXPECT_EQ(first % 1000, 0);
  ASSERT_TRUE(eventually([&] { return step(look()) > first; }));
  // A file that has not been written for long, but is open: the run is slow.
  fs::last_write_time(in_folder("run.h5"),
                      fs::file_time_type::clock::now() - std::chrono::minutes(2));
  EXPECT_TRUE(contains(look(), "under way"));

  EXPECT_EQ(end(process, SIGINT), 130);
  auto const outcome = expect_status(3, {"watch", "run.h5"});
  EXPECT_TRUE(contains(outcome.errors, "run.h5: ended early: interrupted or failed"));
  auto const info = info_of("run.h5");
  EXPECT_EQ(step(outcome.output), info.frame_steps.back());
}

TEST_F(Watching, SpeaksAtMostEveryFiveSecondsWithoutATerminal) {
  auto const process = begin_run("1000000000");
  ASSERT_TRUE(eventually([&] { return exists("run.h5") && step(look()) > 0; }));
  auto const outcome =
      start({"watch", "run.h5"}, {.interrupt_after = 3, .interrupt_when = in_folder("run.h5")});
  EXPECT_TRUE(is_one_line(outcome.output)) << outcome.output;
  EXPECT_EQ(end(process, SIGINT), 130);
}

TEST_F(Watching, KnowsNoShareOfNoSteps) {
  run(chain_scene(), set("integrator.steps=0"));
  EXPECT_TRUE(contains(output_of({"watch", "out.h5", "--once"}), "step 0, t = 0"));
}

TEST_F(Watching, SaysThatARunWasKilled) {
  auto const process = begin_run("1000000000");
  ASSERT_TRUE(eventually([&] { return exists("run.h5") && step(look()) > 0; }));
  EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
  fs::last_write_time(in_folder("run.h5"),
                      fs::file_time_type::clock::now() - std::chrono::minutes(2));
  auto const outcome = expect_status(3, {"watch", "run.h5"});
  EXPECT_TRUE(contains(outcome.errors, "nobody has written it for 2 min"));
}

TEST_F(Watching, TellsTheLastSampleOfACompleteRun) {
  auto const info = run(chain_scene(), set("output.scalars_every=5"));
  auto const energy = testing::PrintToString(info.frame_scalars.back().energy).substr(0, 6);
  EXPECT_TRUE(
      contains_all(output_of({"watch", "out.h5", "--once"}),
                   {"complete", "step 25 of 25 (100.0 %), t = 0.5", "20 x 3 x 1 sites", energy}));
}

TEST_F(Watching, OtherFilesAreRefusedInOneLine) {
  expect_refused({"watch"}, "FILE");
  expect_refused({"watch", "none.h5"}, "No such file");
  expect_refused({"watch", "chain.toml"}, "not an HDF5 file");
  expect_refused({"watch", "."}, "not a regular file");
  io::test::write_dataset(in_folder("other.h5"), "/spins", {1, 1, 1, 3}, {1, 0, 0});
  expect_refused({"watch", "other.h5"}, "attribute format");
  run(chain_scene());
  std::ifstream whole(in_folder("out.h5"), std::ios::binary);
  std::string part(3000, '\0');
  whole.read(part.data(), 3000);
  write("part.h5", part);
  expect_refused({"watch", "part.h5"}, "truncated");
  output_of(
      {"sweep", "chain.toml", "--quiet", "--output", "all.h5", "--over", "system.damping=0.1"});
  expect_refused({"watch", "all.h5"}, "it has a sweep");
}

}  // namespace
}  // namespace cayspin::program::test
