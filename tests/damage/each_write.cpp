// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A process that is killed before any one of its writes to a trajectory file, or at any page in the
// middle of it, leaves every frame that was reported as written.
#include "trajectory/trajectory_test.hpp"

#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <csignal>

namespace {

// Before the kill; -1: there is none. Before a write is one, each page that ends in it another.
long moments_left = -1;

}  // namespace

// HDF5's writes come here. A kill can stop the system between two pages, not within one.
extern "C" ssize_t pwrite(int file, void const* data, size_t bytes, off_t offset) {
  constexpr size_t page = 4096;
  if (moments_left >= 0) {
    size_t const to_page = page - static_cast<size_t>(offset) % page;
    for (size_t written = 0; written < bytes; written += written == 0 ? to_page : page)
      if (moments_left-- == 0) {
        if (written > 0) ::syscall(SYS_pwrite64, file, data, written, offset);
        ::raise(SIGKILL);
      }
  }
  return ::syscall(SYS_pwrite64, file, data, bytes, offset);
}

namespace cayspin::inline v0_1::io {
namespace {

// What a process has been told, which outlives it.
struct Reported {
  bool created = false, finished = false;
  int frames = 0;
};

// Samples before the first frame, and frames and samples before the kill becomes possible.
struct Course {
  int first_frames = 0, frames = 0;
  std::int64_t cell_sites = 1;
  std::int64_t samples(int frames_written) const { return 2 * frames_written + 3; }
};

class Killed : public TrajectoryTest {
 protected:
  Killed() {
    auto* const shared = ::mmap(nullptr, sizeof(Reported), PROT_READ | PROT_WRITE,
                                MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    reported_ = new (shared) Reported;
  }
  ~Killed() override { ::munmap(reported_, sizeof(Reported)); }

  // False when the run ended before that moment.
  bool run_to(Course const& course, long moment) {
    *reported_ = {};
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    pid_t const child = ::fork();
    if (child == 0) perform(course, moment);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status);
  }

  [[noreturn]] void perform(Course const& course, long moment) {
    auto header = small_header();
    header.cell_sites = course.cell_sites;
    if (course.first_frames == 0) moments_left = moment;
    TrajectoryFile file(path(), header, false);
    reported_->created = true;
    for (int frame = 0; frame < course.frames; ++frame) {
      if (frame > 0 && frame == course.first_frames) moments_left = moment;
      for (int sample = 0; sample < 2; ++sample) add_sample(file, 2 * frame + sample);
      file.write_frame(10 * frame, 0.1 * frame, numbered_scalars(frame),
                       numbered_spins<double>(header, frame).data());
      reported_->frames = frame + 1;
    }
    for (int sample = 0; sample < 3; ++sample) add_sample(file, 2 * course.frames + sample);
    file.finish({7, 2, 1});
    reported_->finished = true;
    ::_exit(0);
  }

  static void add_sample(TrajectoryFile& file, int sample) {
    file.write_scalars(sample, 0.01 * sample, numbered_scalars(sample));
  }

  // The file of a process that was killed, or that ended.
  void expect_whole(Course const& course) {
    if (!std::filesystem::exists(path())) {
      EXPECT_FALSE(reported_->created);
      return;
    }
    auto const info = read_info(path());
    EXPECT_GE(info.frames, reported_->frames);
    EXPECT_LE(info.frames, course.frames);
    EXPECT_EQ(info.header.cell_sites, course.cell_sites);
    for (std::int64_t frame = 0; frame < info.frames; ++frame) expect_frame(info, frame);
    if (info.frames > 0) {
      EXPECT_EQ(read_spins(path(), info.header.shape), spins(static_cast<int>(info.frames) - 1));
      EXPECT_EQ(read_spins(path(), info.header.shape, 0), spins(0));
    }
    EXPECT_TRUE(info.complete || !reported_->finished);
    if (!info.complete) return;
    EXPECT_EQ(info.frames, course.frames);
    EXPECT_EQ(info.samples, course.samples(course.frames));
    EXPECT_EQ(info.cost.evaluations, 7);
  }

  static void expect_frame(TrajectoryInfo const& info, std::int64_t frame) {
    auto const expected = numbered_scalars(static_cast<int>(frame));
    auto const& found = info.frame_scalars[static_cast<std::size_t>(frame)];
    EXPECT_EQ(info.frame_steps[static_cast<std::size_t>(frame)], 10 * frame);
    EXPECT_EQ(found.energy, expected.energy);
    EXPECT_EQ(found.magnetization, expected.magnetization);
  }

  static std::vector<double> spins(int frame) {
    return numbered_spins<double>(small_header(), frame);
  }
  std::filesystem::path path() const { return folder_ / "a.h5"; }

  void kill_at_every_write(Course const& course, int stride) {
    int kills = 0;
    for (long moment = 0; run_to(course, moment); moment += stride, ++kills) {
      try {
        expect_whole(course);
      } catch (std::runtime_error const& error) {
        ADD_FAILURE() << error.what();
      }
      if (!HasFailure()) continue;
      FAIL() << "killed at moment " << moment << ", after " << reported_->frames << " frames";
    }
    EXPECT_TRUE(reported_->finished);
    expect_whole(course);
    std::cout << "killed " << kills << " times\n";
  }

  Reported* reported_ = nullptr;
};

int stride(int ordinary) { return std::getenv("CAYSPIN_ALL_KILLS") ? 1 : ordinary; }

TEST_F(Killed, FromTheCreationToTheEnd) { kill_at_every_write({0, 4}, stride(3)); }

TEST_F(Killed, InACrystal) { kill_at_every_write({0, 4, 2}, stride(5)); }

// Index blocks are added here, and by other layouts nodes are split.
TEST_F(Killed, AfterSomeFrames) { kill_at_every_write({60, 70}, stride(15)); }

// The scalars' chunks of 512 are full: samples at frame 256, frames at 512.
TEST_F(Killed, AtTheEndOfAChunkOfSamples) { kill_at_every_write({254, 258}, stride(9)); }
TEST_F(Killed, AtTheEndOfAChunkOfFrames) { kill_at_every_write({510, 514}, stride(19)); }

}  // namespace
}  // namespace cayspin::inline v0_1::io
