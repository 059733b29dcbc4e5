// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Writers of files in a memory file system, killed at random times. CAYSPIN_RANDOM_KILLS and
// CAYSPIN_SEED: number of kills, and the seed.
#include "damaged_bytes.hpp"
#include "hdf5/guarded_reading.hpp"
#include "known_run.hpp"
#include "memory_folder.hpp"
#include "support/reads_in_child.hpp"

#include <sys/mman.h>
#include <sys/wait.h>

#include <atomic>
#include <chrono>
#include <csignal>
#include <iostream>
#include <map>
#include <optional>
#include <thread>

namespace cayspin::inline v0_2::io {
namespace {

using cayspin::test::Chance;
using cayspin::test::number_from;
namespace fs = std::filesystem;

// The reports of a process, in memory that survives it.
struct Reported {
  std::atomic<bool> begun, created, finished;
  std::atomic<std::int64_t> frames, samples;

  Told told() const { return {created, finished, frames, samples}; }
};

struct Course : KnownRun {
  std::int64_t quick_frames = 0;  // frames written before a kill becomes possible
};

[[noreturn]] void perform(fs::path const& path, Course const& course, Reported& reported) {
  if (course.quick_frames == 0) reported.begun = true;
  write_known_run(path, course, [&](Told const& told) {
    reported.created = true;
    reported.samples = told.samples;
    reported.frames = told.frames;
    reported.finished = told.finished;
    if (told.frames >= course.quick_frames) reported.begun = true;
  });
  while (true) ::pause();
}

class RandomKills : public testing::Test {
 protected:
  RandomKills() {
    auto* const shared = ::mmap(nullptr, sizeof(Reported), PROT_READ | PROT_WRITE,
                                MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    reported_ = new (shared) Reported{};
  }
  ~RandomKills() override { ::munmap(reported_, sizeof(Reported)); }

  template <class Value>
  Value one_of(std::initializer_list<Value> values) {
    return values.begin()[chance_.below(values.size())];
  }

  Course random_course(long kill) {
    Course course;
    course.header = small_header(one_of({"single", "double"}));
    course.header.scene_text += "# " + std::to_string(kill) + "\n";
    course.header.shape = one_of<std::array<std::int64_t, 3>>(
        {{1, 1, 1}, {10, 3, 1}, {4, 3, 2}, {57, 1, 1}, {16, 16, 2}, {31, 17, 5}, {64, 32, 3}});
    if (course.header.shape[2] == 1 && chance_.below(2) == 0)
      course.header.cell_sites = course.header.shape[2] = one_of<std::int64_t>({2, 3});
    course.storage = {.compression = one_of({0, 0, 1}),
                      .chunk = one_of<std::int64_t>({0, 0, 1}),
                      .frames = one_of<std::int64_t>({0, 100, 50'000}),
                      .sync = chance_.below(3) == 0};
    bool const small = course.header.shape[2] < 3;
    course.quick_frames = small && chance_.below(20) == 0 ? one_of({250, 505}) : 0;
    course.frames = course.quick_frames + static_cast<std::int64_t>(1 + chance_.below(400));
    course.samples = one_of({0, 1, 7});
    course.replaces = chance_.below(4) == 0;
    return course;
  }

  // In one case in four, lets the run start from the last frame of a file that a kill has left.
  void restart_from_last(Course& course) {
    if (!last_ || chance_.below(4) != 0) return;
    auto const info = read_info(*last_);
    if (info.frames == 0) return;
    course.first_step = info.frame_steps.back();
    course.header.shape = info.header.shape;
    course.header.cell_sites = info.header.cell_sites;
    course.header.precision = info.header.precision;
    course.quick_frames = 0;
    ++counts_["restarts"];
  }

  void kill_at_random(fs::path const& path, Course const& course) {
    new (reported_) Reported{};
    pid_t const child = ::fork();
    if (child == 0) perform(path, course, *reported_);
    int status = 0;
    while (!reported_->begun) {
      ASSERT_EQ(::waitpid(child, &status, WNOHANG), 0) << "it has ended by itself: " << status;
      std::this_thread::yield();
    }
    auto const longest = one_of<std::size_t>({500, 2'000, 8'000});
    std::this_thread::sleep_for(std::chrono::microseconds(chance_.below(longest)));
    ::kill(child, SIGKILL);
    ::waitpid(child, &status, 0);
    ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL) << status;
  }

  void expect_whole(fs::path const& path, Course const& course) {
    if (!fs::exists(path)) {
      EXPECT_FALSE(reported_->created);
      ++counts_["without a file yet"];
      return;
    }
    frames_ += reported_->frames;
    ++counts_[reported_->finished ? "ended" : "cut short"];
    try {
      try_reading(path, [&] { require_known(path, course, reported_->told()); });
      last_ = path;
    } catch (std::runtime_error const& error) {
      std::string const message = error.what();
      ++(message.starts_with("wrong") ? wrong_ : lost_);
      auto const kept = fs::temp_directory_path() / "cayspin_killed.h5";
      fs::copy_file(path, kept, fs::copy_options::overwrite_existing);
      ADD_FAILURE() << message << ", after " << reported_->frames << " frames; kept as "
                    << kept.string();
    }
  }

  // Reads all files with h5py, which has another build of HDF5, and removes them.
  void expect_h5py_opens_all() {
    auto const command = std::string(CAYSPIN_PYTHON) + " -B " + CAYSPIN_OPEN_ALL + " " +
                         folder_.string() + "/*.h5 > " + (folder_ / "opened").string();
    if (!last_) return;
    EXPECT_EQ(std::system(command.c_str()), 0);
    for (auto const& entry : fs::directory_iterator(folder_)) fs::remove(entry.path());
    last_.reset();
  }

  cayspin::test::MemoryFolder memory_{"random_kills"};
  fs::path folder_ = memory_.path();
  Reported* reported_ = nullptr;
  Chance chance_{static_cast<std::uint64_t>(number_from("CAYSPIN_SEED", 1))};
  std::optional<fs::path> last_;
  std::map<std::string, long> counts_;
  std::int64_t frames_ = 0, lost_ = 0, wrong_ = 0;
};

TEST_F(RandomKills, LoseNoFrame) {
  auto const kills = number_from("CAYSPIN_RANDOM_KILLS", 300);
  constexpr long at_once = 200;
  for (long kill = 0; kill < kills; ++kill) {
    auto course = random_course(kill);
    restart_from_last(course);
    auto const path = folder_ / (std::to_string(kill) + ".h5");
    if (course.replaces) write_older_file(path, chance_.below(2) == 0);
    kill_at_random(path, course);
    expect_whole(path, course);
    if (kill % at_once == at_once - 1) expect_h5py_opens_all();
  }
  expect_h5py_opens_all();
  EXPECT_EQ(lost_ + wrong_, 0);
  if (kills >= 100) {
    EXPECT_GT(counts_["cut short"], 0);
    EXPECT_GT(counts_["restarts"], 0);
    EXPECT_GT(frames_, 0);
  }
  std::cout << "SIGKILL, " << kills << " at random: " << lost_ << " lost, " << wrong_ << " wrong; "
            << frames_ << " frames";
  for (auto const& [what, count] : counts_) std::cout << ", " << count << ' ' << what;
  std::cout << '\n';
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
