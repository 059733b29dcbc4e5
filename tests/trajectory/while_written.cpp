// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Reading a file while another process writes it.
#include "trajectory_test.hpp"

#include <sys/stat.h>
#include <sys/wait.h>

namespace cayspin::inline v0_2::io {
namespace {

/// A process that writes a trajectory on request.
class Writer {
 public:
  explicit Writer(std::filesystem::path const& path) {
    if (::pipe(orders_) != 0 || ::pipe(answers_) != 0) throw std::runtime_error("no pipe");
    process_ = ::fork();
    if (process_ == 0) write(path);
  }
  ~Writer() {
    ::close(orders_[1]);
    ::waitpid(process_, nullptr, 0);
  }
  void order(char what) {
    ASSERT_EQ(::write(orders_[1], &what, 1), 1);
    ASSERT_EQ(::read(answers_[0], &what, 1), 1);
  }

 private:
  [[noreturn]] void write(std::filesystem::path const& path) {
    ::close(orders_[1]);
    auto const header = small_header();
    TrajectoryFile file(path, header, true);
    int step = 0;
    for (char what = 0; ::read(orders_[0], &what, 1) == 1;) {
      Scalars const scalars{10.0 + step, 0.5, {1.0 * step, 2, 3}};
      if (what == 'f') {
        file.write_scalars(step, 0.25 * step, scalars);
        file.write_frame(step, 0.25 * step, scalars, numbered_spins<double>(header, step).data());
        ++step;
      }
      if (what == 'e') file.finish({7, 2.5, 1.5});
      [[maybe_unused]] auto const written = ::write(answers_[1], &what, 1);
    }
    ::_exit(0);
  }

  int orders_[2] = {}, answers_[2] = {};
  pid_t process_ = -1;
};

TEST_F(TrajectoryTest, IsReadWhileAnotherProcessWritesIt) {
  auto const path = folder_ / "growing.h5";
  Writer writer(path);
  for (char const what : {'f', 'f'}) writer.order(what);
  auto const info = read_info_while_written(path);
  EXPECT_EQ(info.header.scene_text, small_header().scene_text);
  EXPECT_EQ(info.header.shape, small_header().shape);
  EXPECT_EQ(info.frame_steps, (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(info.frame_times, (std::vector<double>{0, 0.25}));
  EXPECT_EQ(info.samples, 2);
  ASSERT_TRUE(info.last_sample);
  EXPECT_EQ(info.last_sample->step, 1);
  EXPECT_EQ(info.last_sample->time, 0.25);
  EXPECT_EQ(info.last_sample->scalars.energy, 11);
  EXPECT_EQ(info.last_sample->scalars.norm_defect, 0.5);
  EXPECT_EQ(info.last_sample->scalars.magnetization, (std::array<double, 3>{1, 2, 3}));
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.cost.evaluations, 0);
  EXPECT_EQ(is_being_written(path), true);
  EXPECT_THROW(read_info(path), std::runtime_error);  // it would need a lock

  for (char const what : {'f', 'e'}) writer.order(what);
  EXPECT_EQ(is_being_written(path), false);
  auto const whole = read_info_while_written(path);
  EXPECT_TRUE(whole.complete);
  EXPECT_EQ(whole.frames, 3);
  EXPECT_EQ(whole.samples, 3);
  EXPECT_FALSE(whole.last_sample);  // the last frame has it
  EXPECT_EQ(whole.cost.wall_seconds, 2.5);
  EXPECT_EQ(read_info(path).frames, 3);
}

TEST_F(TrajectoryTest, NobodyWritesAPipeOrAMissingFile) {
  auto const pipe = folder_ / "pipe.h5";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_NE(is_being_written(pipe), true);
  EXPECT_EQ(is_being_written(folder_ / "missing.h5"), std::nullopt);
}

TEST_F(TrajectoryTest, NothingHalfWrittenIsReadWhileItIsWritten) {
  auto const path = folder_ / "growing.h5", copy = folder_ / "copy.h5";
  std::string before, after;
  {
    Writer writer(path);
    for (char const what : {'f', 'f'}) writer.order(what);
    before = read_bytes(path);
    writer.order('f');
    after = read_bytes(path);
  }
  ASSERT_NE(before, after);
  before.resize(after.size());
  write_bytes(copy, before);
  int torn = 0, whole = 0;
  for (std::size_t half = 0; half <= after.size(); half += 5120) {
    overwrite(copy, 0, after.substr(0, half) + before.substr(half));
    try {
      auto const info = read_info_while_written(copy);
      ASSERT_TRUE(info.frames == 2 || info.frames == 3) << half;
      for (std::size_t i = 0; i < info.frame_steps.size(); ++i) {
        EXPECT_EQ(info.frame_steps[i], static_cast<std::int64_t>(i)) << half;
        EXPECT_EQ(info.frame_scalars[i].energy, 10.0 + static_cast<double>(i)) << half;
      }
      ASSERT_TRUE(info.last_sample) << half;
      EXPECT_EQ(info.last_sample->step, info.samples - 1) << half;
      EXPECT_EQ(info.last_sample->scalars.energy, 9.0 + static_cast<double>(info.samples)) << half;
      ++whole;
    } catch (std::runtime_error const&) {
      ++torn;
    }
  }
  overwrite(copy, 0, after);
  EXPECT_EQ(read_info_while_written(copy).frames, 3);
  EXPECT_GT(whole, 0);
  RecordProperty("torn", torn);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
