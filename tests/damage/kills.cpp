// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// `cayspin run`, killed at random times, without disk space, or with its file truncated.
// CAYSPIN_KILLS and CAYSPIN_SEED: number of runs of each kind (plain SIGKILL: twice as many), and
// the seed.
#include "damaged_bytes.hpp"
#include "program/program_test.hpp"

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <iostream>
#include <map>
#include <thread>

namespace cayspin::program::test {
namespace {

using cayspin::test::Chance;
using cayspin::test::number_from;
namespace fs = std::filesystem;

// Writes frames as fast as possible.
std::string const scene = R"([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [10, 3]
[field]
exchange = 1.0
applied = [0.3, -0.2, 0.1]
[initial]
random = { seed = 3 }
[integrator]
method = "rkmk4"
dt = 1e-4
steps = 20000000
[output]
every = 4
scalars_every = 1
)";

class Kills : public ProgramTest {
 protected:
  Kills() { write("scene.toml", scene); }

  Arguments run_to(std::string const& name, Arguments const& more = {}) const {
    Arguments arguments{"run", "scene.toml", "--quiet", "--threads", "1", "--output", name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return arguments;
  }

  std::string fresh_name() { return "run_" + std::to_string(number_++) + ".h5"; }

  // Returns what another process can read from the file while it is written; an empty result if the
  // file is missing or half written.
  io::TrajectoryInfo visible(fs::path const& path) const {
    try {
      return io::read_info_while_written(path);
    } catch (std::runtime_error const&) {  // half written, or missing
      return {};
    }
  }

  // Expects the file to be readable and to have every frame and sample that was seen, and expects a
  // run to continue from it.
  void expect_nothing_lost(std::string const& name, io::TrajectoryInfo const& seen) {
    auto const path = in_folder(name);
    if (!fs::exists(path)) {
      EXPECT_EQ(seen.samples, 0);
      ++counts_["no file yet"];
      return;
    }
    auto const info = start({"info", name});
    ASSERT_EQ(info.status, 0) << info.errors << keep(path);
    auto const file = io::read_info(path);
    EXPECT_FALSE(file.complete);
    ASSERT_EQ(file.frame_steps.size(), static_cast<std::size_t>(file.frames));
    // At a step with a frame, the sample is in the file before the frame.
    auto const last_seen = seen.last_sample ? seen.last_sample->step : 0;
    EXPECT_GE(file.samples, seen.samples);
    EXPECT_GE(file.frames, seen.frames);
    auto const last = file.frames == 0 ? -1 : file.frame_steps.back();
    EXPECT_GE(last, last_seen - last_seen % 4 - (last_seen % 4 == 0 ? 4 : 0)) << keep(path);
    // SIGTERM may add a last frame at any step.
    for (std::size_t frame = 0; frame + 1 < file.frame_steps.size(); ++frame)
      EXPECT_EQ(file.frame_steps[frame], 4 * static_cast<std::int64_t>(frame));
    frames_ += file.frames;
    if (file.frames > 0) {
      expect_restarted(name, last, restart(name, last));
    }
    ++counts_["whole"];
  }

  Outcome restart(std::string const& name, std::int64_t last) const {
    return start(run_to("again.h5", {"--overwrite", "--restart", name, "--set",
                                     "integrator.steps=" + std::to_string(last + 8)}));
  }

  void expect_restarted(std::string const& name, std::int64_t last, Outcome const& outcome) {
    auto const again = "again.h5";
    ASSERT_EQ(outcome.status, 0) << outcome.errors << keep(in_folder(name));
    auto const file = io::read_info(in_folder(again));
    EXPECT_TRUE(file.complete);
    EXPECT_EQ(file.frame_steps.front(), last);
    EXPECT_EQ(io::read_spins(in_folder(again), file.header.shape, 0),
              io::read_spins(in_folder(name), file.header.shape));
  }

  std::string keep(fs::path const& path) const {
    auto const kept = fs::temp_directory_path() / "cayspin_killed.h5";
    fs::copy_file(path, kept, fs::copy_options::overwrite_existing);
    return " kept as " + kept.string();
  }

  // Reads the files of a test with h5py, which has another build of HDF5.
  void expect_h5py_opens_all() const {
    auto const command = std::string(CAYSPIN_PYTHON) + " -B " + CAYSPIN_OPEN_ALL + " " +
                         folder_.string() + "/run_*.h5";
    EXPECT_EQ(std::system(command.c_str()), 0);
  }

  // Returns the time to a run's first sample, which is many times longer in a build with checks,
  // and on a slow disk with output.sync.
  std::chrono::microseconds time_to_first_frame(Arguments const& more) {
    auto const name = "first.h5";
    auto const begun = std::chrono::steady_clock::now();
    auto const process = begin(run_to(name, more));
    while (visible(in_folder(name)).samples == 0 &&
           std::chrono::steady_clock::now() - begun < std::chrono::minutes(1))
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    auto const taken = std::chrono::steady_clock::now() - begun;
    end(process, SIGKILL);
    start({"info", name});  // removes the journal
    return std::chrono::duration_cast<std::chrono::microseconds>(taken);
  }

  // About a third of the runs are killed before their first sample. If all are, kills more.
  void kill_with(int signal, long kills, Arguments const& more = {}) {
    auto const longest = static_cast<std::uint64_t>(3 * time_to_first_frame(more).count());
    std::int64_t samples_seen = 0;
    auto const are_early = [&] { return samples_seen == 0 || frames_ == 0; };
    for (long kill = 0; kill < kills || (are_early() && kill < 20 * kills); ++kill) {
      auto const name = fresh_name();
      auto const process = begin(run_to(name, more));
      std::this_thread::sleep_for(std::chrono::microseconds(chance_.below(longest)));
      auto const seen = visible(in_folder(name));
      std::this_thread::sleep_for(std::chrono::microseconds(chance_.below(2'000)));
      int const status = end(process, signal);
      EXPECT_TRUE(status == 128 + signal || (signal == SIGTERM && status == 130)) << status;
      expect_nothing_lost(name, seen);
      samples_seen += seen.samples;
    }
    EXPECT_GT(samples_seen, 0);
    EXPECT_GT(frames_, 0);
  }

  void print_summary(char const* what) const {
    std::cout << what << ':';
    for (auto const& [outcome, count] : counts_) std::cout << ' ' << count << ' ' << outcome << ',';
    std::cout << ' ' << frames_ << " frames" << (HasFailure() ? "" : ", all there") << '\n';
  }

  long kills_ = number_from("CAYSPIN_KILLS", 5);
  Chance chance_{static_cast<std::uint64_t>(number_from("CAYSPIN_SEED", 1))};
  std::map<std::string, long> counts_;
  std::int64_t frames_ = 0;
  int number_ = 0;
};

TEST_F(Kills, SigkillLosesNoFrameThatWasSeen) {
  kill_with(SIGKILL, 2 * kills_);
  expect_h5py_opens_all();
  print_summary("SIGKILL");
}

// `cayspin info` completes each file that has a journal, and removes the journal.
TEST_F(Kills, SigkillWithSyncLosesNoFrameThatWasSeen) {
  kill_with(SIGKILL, kills_, {"--set", "output.sync=true"});
  for (auto const& entry : fs::directory_iterator(folder_))
    EXPECT_NE(entry.path().extension(), ".journal");
  expect_h5py_opens_all();
  print_summary("SIGKILL with sync");
}

TEST_F(Kills, SigtermLosesNoFrameThatWasSeen) {
  kill_with(SIGTERM, kills_);
  expect_h5py_opens_all();
  print_summary("SIGTERM");
}

TEST_F(Kills, FullDiskLosesNoFrameThatWasSeen) {
  for (long run = 0; run < kills_; ++run) {
    auto const name = fresh_name();
    auto const limit = static_cast<long>(1'200'000 + chance_.below(2'000'000));
    auto const outcome = start(run_to(name), {.file_limit = limit});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_TRUE(is_one_line(outcome.errors));
    io::TrajectoryInfo first;
    first.samples = 1;
    if (fs::exists(in_folder(name))) expect_nothing_lost(name, first);
  }
  EXPECT_GT(frames_, 0);
  expect_h5py_opens_all();
  print_summary("full disk");
}

TEST_F(Kills, CutFilesAreRefusedOrRead) {
  auto const whole = in_folder("whole.h5");
  ASSERT_EQ(start(run_to("whole.h5", {"--set", "integrator.steps=2000"})).status, 0);
  auto const bytes = cayspin::test::read_bytes(whole);
  for (long cut = 0; cut < kills_; ++cut) {
    cayspin::test::write_bytes(in_folder("cut.h5"), bytes.substr(0, chance_.below(bytes.size())));
    for (auto const& arguments :
         {Arguments{"info", "cut.h5"}, run_to("again.h5", {"--restart", "cut.h5"})}) {
      auto const outcome = start(arguments);
      EXPECT_EQ(outcome.status, 2);
      EXPECT_TRUE(is_one_line(outcome.errors));
      ++counts_["refused"];
    }
  }
  print_summary("cut");
}

}  // namespace
}  // namespace cayspin::program::test
