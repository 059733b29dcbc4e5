// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A file that another process writes meanwhile.
#include "io/follow.hpp"
#include "trajectory_test.hpp"

#include <sys/wait.h>

namespace cayspin::inline v0_1::io {
namespace {

/// A process that writes a trajectory when it is told to.
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

TEST_F(TrajectoryTest, AFollowerBelievesWhatItSawBefore) {
  auto const path = folder_ / "followed.h5";
  Writer writer(path);
  writer.order('f');
  FollowedTrajectory run(path);
  run.look();
  EXPECT_EQ(run.header().scene_text, small_header().scene_text);
  EXPECT_EQ(run.header().shape, small_header().shape);
  EXPECT_TRUE(run.steps().empty());
  writer.order('f');
  run.look();
  EXPECT_EQ(run.steps(), (std::vector<std::int64_t>{0}));
  run.look();
  EXPECT_EQ(run.steps(), (std::vector<std::int64_t>{0, 1}));
  EXPECT_EQ(run.times(), (std::vector<double>{0, 0.25}));
  EXPECT_EQ(run.scalars()[1].energy, 11);
  EXPECT_EQ(run.scalars()[1].norm_defect, 0.5);
  EXPECT_EQ(run.scalars()[1].magnetization, (std::array<double, 3>{1, 2, 3}));
  EXPECT_FALSE(run.complete());
  EXPECT_EQ(run.cost().evaluations, 0);
  EXPECT_EQ(is_being_written(path), true);
  EXPECT_THROW(read_info(path), std::runtime_error);  // which would take a lock

  writer.order('f');
  writer.order('e');
  run.look();
  EXPECT_TRUE(run.complete());
  EXPECT_EQ(run.steps().size(), 3u);
  EXPECT_EQ(run.cost().wall_seconds, 2.5);
  EXPECT_EQ(is_being_written(path), false);
  EXPECT_EQ(read_info(path).frames, 3);
}

TEST_F(TrajectoryTest, AFollowerBeginsAgainWithAnotherFile) {
  auto const path = folder_ / "replaced.h5";
  FollowedTrajectory run(path);
  EXPECT_THROW(run.look(), std::runtime_error);
  {
    Writer writer(path);
    for (char const what : {'f', 'f', 'f', 'e'}) writer.order(what);
  }
  run.look();
  EXPECT_EQ(run.steps().size(), 3u);
  Writer writer(path);  // beside it, then in its place
  for (char const what : {'f', 'f', 'e'}) writer.order(what);
  run.look();
  EXPECT_EQ(run.steps().size(), 2u);
}

TEST_F(TrajectoryTest, AFollowerRefusesAPartOfAFile) {
  auto const whole = folder_ / "whole.h5", part = folder_ / "part.h5";
  {
    Writer writer(whole);
    for (char const what : {'f', 'f', 'e'}) writer.order(what);
  }
  auto const text = read_bytes(whole);
  for (std::size_t length = 0; length < text.size(); length += 1009) {
    write_bytes(part, text.substr(0, length));
    EXPECT_THROW(FollowedTrajectory(part).look(), std::runtime_error) << length;
  }
}

TEST_F(TrajectoryTest, AFollowerBelievesNothingHalfWritten) {
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
  auto const expect_samples = [&](FollowedTrajectory const& run, std::size_t count,
                                  std::size_t half) {
    ASSERT_EQ(run.steps().size(), count) << half;
    for (std::size_t i = 0; i < count; ++i) {
      EXPECT_EQ(run.steps()[i], static_cast<std::int64_t>(i)) << half;
      EXPECT_EQ(run.scalars()[i].energy, 10.0 + static_cast<double>(i)) << half;
    }
  };
  int torn = 0;
  for (std::size_t half = 0; half <= after.size(); half += 5120) {
    overwrite(copy, 0, before);
    FollowedTrajectory run(copy);
    run.look();
    run.look();
    expect_samples(run, 2, half);
    overwrite(copy, 0, after.substr(0, half) + before.substr(half));
    try {
      run.look();
    } catch (std::runtime_error const&) {
      ++torn;
    }
    expect_samples(run, 2, half);
    overwrite(copy, 0, after);
    run.look();
    run.look();
    expect_samples(run, 3, half);
  }
  RecordProperty("torn", torn);
}

}  // namespace
}  // namespace cayspin::inline v0_1::io
