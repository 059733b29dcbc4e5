// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// cayspin info, also of a run that is writing its file.
#include "../scene/hdf5_file.hpp"
#include "program_test.hpp"

#include <chrono>
#include <csignal>
#include <fstream>

namespace cayspin::program::test {
namespace {

namespace fs = std::filesystem;

class Info : public ProgramTest {
 protected:
  pid_t begin_run(std::string const& steps, Arguments const& more = {}) const {
    return begin(joined(
        {"run", "chain.toml", "--quiet", "--overwrite", "--threads", "1", "--output", "run.h5"},
        joined(set("integrator.steps=" + steps, "output.every=1000000000",
                   "output.scalars_every=1000"),
               more)));
  }

  std::string info() const { return output_of({"info", "run.h5"}); }

  /// Returns the step in the line "progress", or -1.
  static std::int64_t step(std::string const& output) {
    std::string const before = "\nprogress     step ";
    auto const place = output.find(before);
    return place == output.npos ? -1 : std::stoll(output.substr(place + before.size()));
  }

  bool has_begun() const { return exists("run.h5") && step(info()) > 0; }
};

TEST_F(Info, SaysWhatAFileHolds) {
  run(chain_scene());
  auto const output = output_of({"info", "out.h5"});
  EXPECT_TRUE(contains_all(
      output, {"complete     yes", "20 x 3 x 1 sites, double precision", "frames       4",
               "step 25, t = 0.5", "100 evaluations", "random = { seed = 3 }"}));
  EXPECT_FALSE(contains(output, "progress"));
  run_into("one.h5", chain_scene(), {"--threads", "1"});
  EXPECT_TRUE(contains(output_of({"info", "one.h5"}), ", 1 thread\n"));
}

TEST_F(Info, SaysThatARunFailed) {
  run_into("out.h5", chain_scene(),
           set("integrator.method='classical_euler'", "integrator.dt=100.0"));
  EXPECT_TRUE(contains_all(output_of({"info", "out.h5"}),
                           {"complete     no: interrupted or failed", " of 25 (", "\ncost "}));
}

TEST_F(Info, ReadsAnEnsembleWhileItIsWritten) {
  auto const process =
      begin(joined({"run", "chain.toml", "--quiet", "--threads", "1", "--output", "all.h5"},
                   set("ensemble.replicas=2", "integrator.steps=1000000000", "output.every=1000000",
                       "output.scalars_every=1000000")));
  EXPECT_TRUE(eventually([&] { return exists("all.h5"); }));
  EXPECT_TRUE(contains_all(output_of({"info", "all.h5"}),
                           {"an ensemble of 2 replicas", "complete     no: still running\n"}));
  EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
  EXPECT_TRUE(contains_all(output_of({"info", "all.h5"}),
                           {"an ensemble of 2 replicas", "complete     no\n"}));
}

TEST_F(Info, SaysHowFarARunIs) {
  auto const process = begin_run("1000000000");
  ASSERT_TRUE(eventually([&] { return has_begun(); }));
  auto const output = info();
  EXPECT_TRUE(contains_all(output, {"complete     no: still running", " of 1000000000 (", "\ntime ",
                                    "spin updates/s, ", " left\n", "\nlast sample  step "}));
  EXPECT_FALSE(contains(output, "\ncost "));
  auto const first = step(output);
  EXPECT_EQ(first % 1000, 0);
  ASSERT_TRUE(eventually([&] { return step(info()) > first; }));
  // As long as a run has its file open, `info` reports it as running, even if the file was not
  // written for some time.
  fs::last_write_time(in_folder("run.h5"),
                      fs::file_time_type::clock::now() - std::chrono::minutes(2));
  EXPECT_TRUE(contains(info(), "still running"));

  EXPECT_EQ(end(process, SIGINT), 130);
  auto const ended = info();
  EXPECT_TRUE(contains_all(ended, {"complete     no: interrupted or failed", "\ncost "}));
  EXPECT_EQ(step(ended), info_of("run.h5").frame_steps.back());
}

TEST_F(Info, SaysThatARunWasKilled) {
  auto const process = begin_run("1000000000");
  ASSERT_TRUE(eventually([&] { return has_begun(); }));
  EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
  auto const output = info();
  EXPECT_TRUE(contains_all(output, {"complete     no: killed", "\ntime ", "spin updates/s\n"}));
  EXPECT_FALSE(contains(output, " left\n"));
}

// With adaptive methods samples are not steps, so `info` prints no rate of steps.
TEST_F(Info, KnowsNoRateOfAdaptiveMethods) {
  auto const process = begin_run(
      "1000000000", set("integrator={method='tsit5',tolerance=1e-6,dt=0.02,steps=1000000000}"));
  ASSERT_TRUE(eventually([&] { return has_begun(); }));
  auto const output = info();
  EXPECT_EQ(end(process, SIGKILL), 128 + SIGKILL);
  EXPECT_TRUE(contains_all(output, {"\ntime ", " left\n"}));
  EXPECT_FALSE(contains(output, "updates/s"));
}

TEST_F(Info, ChangesNoBitOfARun) {
  auto const steps = set("output.every=50000");
  auto const process = begin_run("200000", steps);
  ASSERT_TRUE(eventually([&] { return exists("run.h5"); }));
  EXPECT_TRUE(eventually([&] { return contains(info(), "complete     yes"); }));
  EXPECT_EQ(end(process, 0), 0);
  auto const read = read_dataset("run.h5", "/spins").values;
  EXPECT_EQ(end(begin_run("200000", steps), 0), 0);
  EXPECT_EQ(read_dataset("run.h5", "/spins").values, read);
  EXPECT_EQ(read.size(), 5u * 60 * 3);
}

TEST_F(Info, OtherFilesAreRefusedInOneLine) {
  expect_refused({"info", "."}, "not a regular file");
  io::test::write_dataset(in_folder("other.h5"), "/spins", {1, 1, 1, 3}, {1, 0, 0});
  expect_refused({"info", "other.h5"}, "attribute format");
  run(chain_scene());
  std::ifstream whole(in_folder("out.h5"), std::ios::binary);
  std::string part(3000, '\0');
  whole.read(part.data(), 3000);
  write("part.h5", part);
  expect_refused({"info", "part.h5"}, "truncated");
}

}  // namespace
}  // namespace cayspin::program::test
