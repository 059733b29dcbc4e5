// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A process that is killed before any of its writes to a trajectory file, or at any page boundary
// within a write, leaves every frame that was reported as written.
#include "known_run.hpp"

#include <sys/mman.h>
#include <sys/syscall.h>
#include <sys/wait.h>

#include <csignal>

namespace {

// Number of possible kill points to pass before the kill; -1: no kill. There is one kill point
// before each write, and one at each page boundary within it.
long moments_left = -1;

}  // namespace

// Intercepts HDF5's writes. A kill can interrupt a write between two pages, not within one.
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

namespace cayspin::inline v0_2::io {
namespace {

struct Course : KnownRun {
  std::int64_t first_frames = 0;  // frames written before the kill becomes possible
};

Course course(std::int64_t first_frames, std::int64_t frames, std::int64_t cell_sites = 1) {
  Course course{{.frames = frames, .samples = 2, .last_samples = 3}, first_frames};
  course.header.cell_sites = cell_sites;
  return course;
}

class Killed : public TrajectoryTest {
 protected:
  Killed() {
    auto* const shared =
        ::mmap(nullptr, sizeof(Told), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    told_ = new (shared) Told;
  }
  ~Killed() override { ::munmap(told_, sizeof(Told)); }

  // Performs the course in a child process that is killed at kill point number `moment`. Returns
  // false if the run ended before it.
  bool run_to(Course const& course, long moment) {
    *told_ = {};
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    pid_t const child = ::fork();
    if (child == 0) perform(course, moment);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFSIGNALED(status);
  }

  [[noreturn]] void perform(Course const& course, long moment) {
    if (course.first_frames == 0) moments_left = moment;
    write_known_run(path(), course, [&](Told const& told) {
      *told_ = told;
      if (told.frames > 0 && told.frames == course.first_frames) moments_left = moment;
    });
    ::_exit(0);
  }

  // Checks the file of a process that was killed, or that ended.
  void expect_whole(Course const& course) {
    if (std::filesystem::exists(path()))
      require_known(path(), course, *told_);
    else
      EXPECT_FALSE(told_->created);
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
      FAIL() << "killed at moment " << moment << ", after " << told_->frames << " frames";
    }
    EXPECT_TRUE(told_->finished);
    expect_whole(course);
    std::cout << "killed " << kills << " times\n";
  }

  Told* told_ = nullptr;  // survives the process that writes it
};

int stride(int ordinary) { return std::getenv("CAYSPIN_ALL_KILLS") ? 1 : ordinary; }

TEST_F(Killed, FromTheCreationToTheEnd) { kill_at_every_write(course(0, 4), stride(3)); }

TEST_F(Killed, InACrystal) { kill_at_every_write(course(0, 4, 2), stride(5)); }

// At these frames HDF5 adds blocks to its indices or, in other layouts, splits their nodes.
TEST_F(Killed, AfterSomeFrames) { kill_at_every_write(course(60, 70), stride(15)); }

// Chunks of 512 scalars become full: those of samples, two for each frame, at frame 256, and those
// of frames at frame 512.
TEST_F(Killed, AtTheEndOfAChunkOfSamples) { kill_at_every_write(course(254, 258), stride(9)); }
TEST_F(Killed, AtTheEndOfAChunkOfFrames) { kill_at_every_write(course(510, 514), stride(19)); }

}  // namespace
}  // namespace cayspin::inline v0_2::io
