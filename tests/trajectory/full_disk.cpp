// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The disk fills up or fails during a run. The runs are child processes, whose exit status also
// shows whether HDF5 could close.
#include "hdf5/handle.hpp"
#include "io/ensemble_file.hpp"
#include "io/scene.hpp"
#include "trajectory/format.hpp"
#include "trajectory_test.hpp"

#include <fcntl.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstddef>
#include <cstdlib>
#include <iterator>
#include <span>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

// A process that exceeds the limit is killed, unless it ignores the signal.
void limit_file_size(rlim_t bytes) {
  rlimit const limit{bytes, bytes};
  if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) std::exit(9);
}

[[noreturn]] void write_until_it_fails(fs::path const& path, rlim_t room, bool sync = false) {
  limit_file_size(room);
  exit_after([&] { write_frames(path, 1000000, {.sync = sync}); });
}

/// These tests use a disk that is too small for the coverage data of a program.
class SmallDisk : public TrajectoryTest {
 protected:
  void SetUp() override {
    if (std::getenv("CAYSPIN_COVERAGE"))
      GTEST_SKIP() << "the counts of executed lines do not fit on this disk, either";
  }
};

TEST_F(TrajectoryTest, FullDiskLeavesTheFramesThatFitted) {
  for (bool const sync : {false, true}) {
    auto const path = folder_ / (sync ? "synced_a.h5" : "a.h5");
    EXPECT_EXIT(write_until_it_fails(path, 1000000, sync), testing::ExitedWithCode(3),
                "a.h5: cannot write the file: File too large$");
    auto const info = read_info(path);
    EXPECT_FALSE(info.complete);
    ASSERT_GT(info.frames, 10);
    EXPECT_EQ(read_spins(path, small_header().shape),
              numbered_spins<double>(small_header(), static_cast<int>(info.frames) - 1));
  }
}

TEST_F(SmallDisk, FullDiskAtCreationLeavesNothing) {
  auto const path = folder_ / "a.h5";
  for (rlim_t const room : {10000, 100000, 500000})
    EXPECT_EXIT(write_until_it_fails(path, room), testing::ExitedWithCode(3),
                "a.h5: cannot create the file: File too large$");
  EXPECT_TRUE(fs::is_empty(folder_));
}

[[noreturn]] void overwrite_on_full_disk(fs::path const& path) {
  limit_file_size(10000);
  exit_after([&] { TrajectoryFile(path, small_header(), true); });
}

TEST_F(SmallDisk, FullDiskAtOverwritingKeepsTheOldFile) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 2).finish({});
  EXPECT_EXIT(overwrite_on_full_disk(path), testing::ExitedWithCode(3),
              "a.h5: cannot create the file: File too large$");
  EXPECT_TRUE(read_info(path).complete);
  EXPECT_FALSE(fs::exists(folder_ / "a.h5.partial"));
}

[[noreturn]] void end_on_full_disk(fs::path const& path) {
  exit_after([&] {
    auto file = write_frames(path, 5);
    for (int sample = 0; sample < most_pending + 9; ++sample)
      file.write_scalars(50 + sample, 5, numbered_scalars(5));
    limit_file_size(fs::file_size(path));
    file.finish({});
  });
}

// Space is reserved for the last samples, too.
TEST_F(SmallDisk, FullDiskAtTheEndKeepsTheFrames) {
  auto const path = folder_ / "a.h5";
  EXPECT_EXIT(end_on_full_disk(path), testing::ExitedWithCode(3),
              "a.h5: cannot write the file: File too large$");
  auto const info = read_info(path);
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 5);
}

[[noreturn]] void write_ensemble_until_it_fails(fs::path const& path, rlim_t room) {
  limit_file_size(room);
  exit_after([&] {
    constexpr int replicas = 20;
    Ensemble ensemble;
    ensemble.replicas = replicas;
    EnsembleFile file(path, small_header(), ensemble, {.storage = {.frames = 1000000}});
    std::vector<std::byte> all;
    for (int replica = 0; replica < replicas; ++replica) {
      auto const spins = numbered_spins<double>(small_header(), replica);
      std::ranges::copy(std::as_bytes(std::span(spins)), std::back_inserter(all));
    }
    for (int frame = 0; frame < 1000000; ++frame)
      file.write_frame(frame, frame, std::vector<Scalars>(replicas), all);
  });
}

// A chunk holds 123 frames, 1.4 MB. The disk is full before the first frame, and later.
TEST_F(SmallDisk, FullDiskLeavesTheFramesOfAnEnsemble) {
  auto const path = folder_ / "a.h5";
  for (rlim_t const room : {2000000, 2400000, 2800000, 6000000}) {
    EXPECT_EXIT(write_ensemble_until_it_fails(path, room), testing::ExitedWithCode(3),
                "a.h5: cannot write the file: File too large$");
    auto const info = read_ensemble_info(path);
    EXPECT_FALSE(info.complete);
    EXPECT_EQ(info.frames > 0, room > 2500000) << room;
    if (info.frames > 0) {
      EXPECT_EQ(read_ensemble_spins(path, info, {0, 20}).size(), 20 * 3 * 24U);
    }
    fs::remove(path);
  }
}

// Makes all later writes to `path` fail, as on a broken disk.
void make_read_only(fs::path const& path) {
  for (auto const& entry : fs::directory_iterator("/proc/self/fd")) {
    std::error_code error;
    if (fs::read_symlink(entry.path(), error) != path) continue;
    int const reading = ::open(path.c_str(), O_RDONLY);
    ::dup2(reading, std::stoi(entry.path().filename().string()));
    ::close(reading);
    return;
  }
  std::exit(9);
}

[[noreturn]] void write_to_broken_disk(
    fs::path const& path, bool sync = false, void (*first_use_of_hdf5)() = [] {}) {
  first_use_of_hdf5();
  auto const spins = numbered_spins<double>(small_header(), 0);
  exit_after([&] {
    auto file = write_frames(path, 5, {.sync = sync});
    make_read_only(fs::canonical(path));
    file.write_frame(5, 5, {}, spins.data());
  });
}

TEST_F(TrajectoryTest, FailedWriteIsReportedAndLeavesTheFileAsItWas) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");  // in a process where HDF5 has not started
  auto const path = folder_ / "a.h5";
  EXPECT_EXIT(write_to_broken_disk(path), testing::ExitedWithCode(3),
              "a.h5: cannot write .*: Bad file descriptor$");
  auto const info = read_info(path);
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 5);
}

// The journal contains the frame that could not be written to the file.
TEST_F(TrajectoryTest, FailedWriteOfASyncedFileIsReportedAndLosesNothing) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  auto const path = folder_ / "a.h5";
  EXPECT_EXIT(write_to_broken_disk(path, true), testing::ExitedWithCode(3),
              "a.h5: cannot write .*: Bad file descriptor$");
  auto const info = read_info(path);
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 6);
  EXPECT_EQ(read_spins(path, small_header().shape, 4), numbered_spins<double>(small_header(), 4));
  EXPECT_EQ(read_spins(path, small_header().shape), numbered_spins<double>(small_header(), 0));
}

void look_for_a_start() {
  Scene scene;
  scene.initial = FileStart{"missing.h5"};
  EXPECT_THROW(check_files(scene), SceneError);
}

TEST_F(TrajectoryTest, FailedWriteOfARunFromAFileIsReported) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  auto const path = folder_ / "a.h5";
  EXPECT_EXIT(write_to_broken_disk(path, false, look_for_a_start), testing::ExitedWithCode(3),
              "a.h5: cannot write .*: Bad file descriptor$");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
