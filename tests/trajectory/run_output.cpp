// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The files of a run, written by a separate thread.
#include "io/run_output.hpp"

#include "trajectory/scalar_table.hpp"
#include "trajectory_test.hpp"

#include <sys/resource.h>
#include <sys/stat.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>
#include <set>
#include <sstream>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

template <class Real>
void hand_over(RunOutput& output, int frame) {
  output.write_scalars(10 * frame, 0.1 * frame, numbered_scalars(frame));
  auto const spins = numbered_spins<Real>(small_header(), frame);
  std::ranges::copy(spins, output.template frame<Real>());
  output.write_frame(10 * frame, 0.1 * frame, numbered_scalars(frame));
}

template <class Real>
void expect_frames(fs::path const& path, int frames) {
  auto const info = read_info(path);
  ASSERT_EQ(info.frames, frames);
  EXPECT_EQ(info.samples, frames);
  for (int frame = 0; frame < frames; ++frame) {
    auto const at = static_cast<std::size_t>(frame);
    EXPECT_EQ(info.frame_steps[at], 10 * frame);
    EXPECT_EQ(info.frame_scalars[at].energy, numbered_scalars(frame).energy);
    auto const expected = numbered_spins<Real>(small_header(), frame);
    EXPECT_EQ(read_spins(path, small_header().shape, frame),
              std::vector<double>(expected.begin(), expected.end()));
  }
}

template <class Real>
void write_and_expect(fs::path const& path, std::string const& precision) {
  RunOutput output(path, small_header(precision), {});
  for (int frame = 0; frame < 100; ++frame) hand_over<Real>(output, frame);
  EXPECT_EQ(output.frames(), 100);
  output.finish({7, 2, 1});
  expect_frames<Real>(path, 100);
  EXPECT_TRUE(read_info(path).complete);
  EXPECT_EQ(read_info(path).cost.evaluations, 7);
}

TEST_F(TrajectoryTest, OutputHoldsWhatWasHandedOver) {
  write_and_expect<double>(folder_ / "double.h5", "double");
  write_and_expect<float>(folder_ / "single.h5", "single");
}

// Frames are written whole or in chunks of one plane. Both files have the same spins.
TEST_F(TrajectoryTest, OutputIsTheSameWithAndWithoutChunks) {
  auto const whole = folder_ / "whole.h5", cut = folder_ / "cut.h5";
  for (auto const& [path, chunk] : {std::pair{whole, 0}, {cut, 1}}) {
    RunOutput output(path, small_header(), {.storage = {.chunk = chunk}});
    for (int frame = 0; frame < 3; ++frame) hand_over<double>(output, frame);
    output.finish({});
    expect_frames<double>(path, 3);
  }
}

// NaNs have all bits set. Each frame has more than 2^20 words, after which Fletcher32 first reduces
// its sums.
TEST_F(TrajectoryTest, OutputOfZerosAndOfNaNsIsReadBack) {
  auto header = small_header("single");
  header.shape = {100, 100, 100};
  for (float const value : {0.0F, std::bit_cast<float>(0xffffffffU), 1 / 3.0F}) {
    auto const path = folder_ / "a.h5";
    RunOutput output(path, header, {.overwrite = true});
    std::vector<float> numbers(3000000, value);
    for (std::size_t i = 0; i < numbers.size() && !std::isnan(value); ++i)
      if (i % 7 != 0) numbers[i] = 0;
    std::ranges::copy(numbers, output.frame<float>());
    output.write_frame(0, 0, {});
    output.finish({});
    EXPECT_TRUE(std::ranges::equal(read_spins(path, header.shape), numbers, [](double a, double b) {
      return a == b || (std::isnan(a) && std::isnan(b));
    }));
  }
}

TEST_F(TrajectoryTest, OutputThatIsDroppedWritesWhatWasHandedOver) {
  auto const path = folder_ / "a.h5";
  {
    RunOutput output(path, small_header(), {.table = true});
    for (int frame = 0; frame < 20; ++frame) hand_over<double>(output, frame);
    output.write_scalars(200, 20, numbered_scalars(20));
  }
  EXPECT_FALSE(read_info(path).complete);
  EXPECT_EQ(read_info(path).frames, 20);
  EXPECT_EQ(read_info(path).samples, 21);
  EXPECT_EQ(std::ranges::count(read_bytes(folder_ / "a.txt"), '\n'), 22);
}

// Samples reach the files without waiting for the next frame.
TEST_F(TrajectoryTest, OutputHandsOverManySamplesWithoutAFrame) {
  RunOutput output(folder_ / "a.h5", small_header(), {.table = true});
  for (int sample = 0; sample < 1024; ++sample)
    output.write_scalars(sample, sample, numbered_scalars(sample));
  EXPECT_EQ(output.frames(), 0);  // waits until all is written
  EXPECT_EQ(std::ranges::count(read_bytes(folder_ / "a.txt"), '\n'), 1 + 1024);
}

TEST_F(TrajectoryTest, OutputHasRoomForTwoFrames) {
  RunOutput output(folder_ / "a.h5", small_header(), {});
  std::set<double*> rooms;
  for (int frame = 0; frame < 50; ++frame) {
    rooms.insert(output.frame<double>());
    hand_over<double>(output, frame);
  }
  EXPECT_LE(rooms.size(), 2U);
}

TEST_F(TrajectoryTest, OutputThatHasEndedTakesNothing) {
  RunOutput output(folder_ / "a.h5", small_header(), {});
  EXPECT_THROW(output.frame<float>(), std::logic_error);
  hand_over<double>(output, 0);
  output.close({});
  EXPECT_THROW(output.frame<double>(), std::logic_error);
  EXPECT_THROW(output.write_scalars(1, 1, {}), std::logic_error);
  EXPECT_THROW(output.finish({}), std::logic_error);
  EXPECT_FALSE(read_info(folder_ / "a.h5").complete);
}

[[noreturn]] void hand_over_until_it_fails(fs::path const& path) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit const limit{1000000, 1000000};
  ::setrlimit(RLIMIT_FSIZE, &limit);
  exit_after([&] {
    RunOutput output(path, small_header(), {});
    for (int frame = 0; frame < 1000000; ++frame) hand_over<double>(output, frame);
  });
}

TEST_F(TrajectoryTest, OutputOnAFullDiskThrowsAndKeepsTheFramesThatFitted) {
  auto const path = folder_ / "a.h5";
  EXPECT_EXIT(hand_over_until_it_fails(path), testing::ExitedWithCode(3),
              "a.h5: cannot write the file: File too large$");
  auto const info = read_info(path);
  EXPECT_FALSE(info.complete);
  ASSERT_GT(info.frames, 10);
  EXPECT_EQ(read_spins(path, small_header().shape),
            numbered_spins<double>(small_header(), static_cast<int>(info.frames) - 1));
}

TEST_F(TrajectoryTest, OutputOfAKilledRunHasWholeFrames) {
  auto const path = folder_ / "a.h5";
  auto const die = [&] {
    RunOutput output(path, small_header(), {.xdmf = true, .table = true});
    for (int frame = 0; frame < 100; ++frame) hand_over<double>(output, frame);
    if (output.frames() == 100) std::raise(SIGKILL);
  };
  EXPECT_EXIT(die(), testing::KilledBySignal(SIGKILL), "");
  expect_frames<double>(path, 100);
  EXPECT_TRUE(contains(read_bytes(folder_ / "a.xdmf"), "frame 99"));
  EXPECT_EQ(std::ranges::count(read_bytes(folder_ / "a.txt"), '\n'), 101);
}

TEST_F(TrajectoryTest, FilesBesideTheTrajectoryAreKeptUnlessOverwritten) {
  auto const path = folder_ / "a.h5";
  auto const all = RunOutputOptions{.xdmf = true, .table = true};
  for (auto const* const name : {"a.txt", "a.xdmf"}) {
    write_bytes(folder_ / name, "kept");
    EXPECT_TRUE(contains(error_line(folder_ / name, [&] { RunOutput(path, small_header(), all); }),
                         "it exists"));
    EXPECT_EQ(read_bytes(folder_ / name), "kept");
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
    fs::remove(folder_ / name);
  }
  write_bytes(folder_ / "a.txt", "old");
  auto replacing = all;
  replacing.overwrite = true;
  { RunOutput const output(path, small_header(), replacing); }
  EXPECT_EQ(read_bytes(folder_ / "a.txt"),
            "# t ()\tmx ()\tmy ()\tmz ()\tE_total ()\tnorm_defect ()\n");
  auto const named = folder_ / "b.txt";
  EXPECT_TRUE(contains(error_line(named, [&] { RunOutput(named, small_header(), all); }),
                       "cannot end in .txt"));
}

TEST_F(TrajectoryTest, OldTrajectoryIsKeptIfAFileBesideItCannotBeWritten) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 3).finish({});
  for (auto const* const name : {"a.txt", "a.xdmf"}) {
    auto const blocked = folder_ / (std::string(name) + ".partial");
    fs::create_directory(blocked);
    EXPECT_THROW(RunOutput(path, small_header(), {.overwrite = true, .xdmf = true, .table = true}),
                 std::runtime_error);
    fs::remove(blocked);
    EXPECT_EQ(read_info(path).frames, 3);
    EXPECT_TRUE(read_info(path).complete);
    EXPECT_FALSE(fs::exists(folder_ / "a.h5.partial"));
  }
}

TEST_F(TrajectoryTest, FilesBesideTheTrajectoryMayBeLinks) {
  write_bytes(folder_ / "table.txt", "old");
  fs::create_symlink("table.txt", folder_ / "a.txt");
  { RunOutput const output(folder_ / "a.h5", small_header(), {.overwrite = true, .table = true}); }
  EXPECT_TRUE(fs::is_symlink(folder_ / "a.txt"));
  EXPECT_EQ(read_bytes(folder_ / "table.txt").front(), '#');
}

// At the end, the XDMF file still lacks frames, unless the last ten took more than a second.
TEST_F(TrajectoryTest, TrajectoryIsCompleteIfItsXdmfFileCannotBeWritten) {
  auto const path = folder_ / "a.h5";
  RunOutput output(path, small_header(), {.xdmf = true});
  for (int frame = 0; frame < 1010; ++frame) hand_over<double>(output, frame);
  EXPECT_EQ(output.frames(), 1010);
  fs::create_directory(folder_ / "a.xdmf.partial");
  try {
    output.finish({});
  } catch (std::runtime_error const&) {
  }
  EXPECT_TRUE(read_info(path).complete);
}

TEST_F(TrajectoryTest, TableGivesTheDoublesBack) {
  auto header = small_header();
  header.units.si = true;
  RunOutput output(folder_ / "a.h5", header, {.table = true});
  Scalars const awkward{-1 / 3., 5e-324, {0.1, 1 - 1e-16, -1e300}};
  output.write_scalars(1, 1 / 7., awkward);
  output.finish({});
  std::ifstream stream(folder_ / "a.txt");
  std::string line;
  std::getline(stream, line);
  EXPECT_EQ(line, "# t (s)\tmx ()\tmy ()\tmz ()\tE_total (J)\tnorm_defect ()");
  std::getline(stream, line);
  double numbers[6];
  char const* at = line.c_str();
  for (auto& number : numbers) {
    char* end = nullptr;
    number = std::strtod(at, &end);
    at = end;
  }
  EXPECT_EQ(*at, '\0');
  EXPECT_EQ(std::ranges::count(line, '\t'), 5);
  EXPECT_EQ((std::vector<double>(numbers, numbers + 6)),
            (std::vector<double>{1 / 7., 0.1, 1 - 1e-16, -1e300, -1 / 3., 5e-324}));
}

// Lines that do not fit completely are removed, so a table never ends in part of a line.
TEST_F(TrajectoryTest, TableOnAFullDiskKeepsWholeLines) {
  auto const path = folder_ / "a.txt";
  ScalarTable table(path, false, false);
  Sample const sample{1, 0.5, numbered_scalars(1)};
  table.append({{sample}});
  auto const before = read_bytes(path);
  EXPECT_EQ(std::ranges::count(before, '\n'), 2);

  auto* const handler = std::signal(SIGXFSZ, SIG_IGN);
  rlimit unlimited{};
  ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &unlimited), 0);
  rlimit const limit{before.size() + 30, unlimited.rlim_max};
  ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &limit), 0);
  auto const message = error_line(path, [&] { table.append({{sample}, {sample}}); });
  ::setrlimit(RLIMIT_FSIZE, &unlimited);
  std::signal(SIGXFSZ, handler);
  EXPECT_TRUE(contains(message, "cannot write the file: File too large"));
  EXPECT_EQ(read_bytes(path), before);
  table.append({{sample}});
  EXPECT_EQ(read_bytes(path), before + before.substr(before.find('\n') + 1));
}

int table_without_permission(fs::path const& path) {
  if (::geteuid() == 0 && ::seteuid(65534) != 0) return 2;
  ::umask(0222);
  auto const message = error_line(path, [&] { ScalarTable(path, false, false); });
  return contains(message, "cannot write the file: Permission denied") ? 0 : 1;
}

TEST_F(TrajectoryTest, TableThatCannotBeOpenedAgain) {
  ASSERT_EQ(::chmod(folder_.c_str(), 0777), 0);
  EXPECT_EXIT(std::_Exit(table_without_permission(folder_ / "a.txt")), testing::ExitedWithCode(0),
              "");
}

// Beyond 1000 frames, the XDMF file is written at most once a second, and at the end.
TEST_F(TrajectoryTest, XdmfDescribesTheLastOfManyFrames) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "it writes a file a thousand times: minutes with the sanitizer";
#endif
  RunOutput output(folder_ / "a.h5", small_header(), {.xdmf = true});
  for (int frame = 0; frame < 1003; ++frame) hand_over<double>(output, frame);
  output.finish({});
  auto const text = read_bytes(folder_ / "a.xdmf");
  EXPECT_TRUE(contains(text, "<Grid Name=\"frame 1002\""));
  EXPECT_FALSE(contains(text, "<Grid Name=\"frame 1003\""));
  EXPECT_TRUE(text.ends_with("</Xdmf>\n"));
}

TEST_F(TrajectoryTest, XdmfDescribesEveryFrameThatIsInTheFile) {
  RunOutput output(folder_ / "a&b.h5", small_header("single"),
                   {.xdmf = true, .spacing = {0.5, 1, 2}});
  auto const path = folder_ / "a&b.xdmf";
  EXPECT_TRUE(read_bytes(path).ends_with("</Xdmf>\n"));
  for (int frame = 0; frame < 3; ++frame) {
    hand_over<float>(output, frame);
    ASSERT_EQ(output.frames(), frame + 1);
    auto const text = read_bytes(path);
    EXPECT_TRUE(text.ends_with("</Xdmf>\n"));
    EXPECT_TRUE(contains(text, "<Grid Name=\"frame " + std::to_string(frame) + "\""));
    EXPECT_FALSE(contains(text, "<Grid Name=\"frame " + std::to_string(frame + 1) + "\""));
  }
  auto const text = read_bytes(path);
  for (auto const* const part : {"Dimensions=\"2 3 4\"/>", ">1 0.5 0.25</", ">2 1 0.5</",
                                 "Precision=\"4\"", "a&amp;b.h5:/spins", "<Time Value=\"0.2\"/>"})
    EXPECT_TRUE(contains(text, part));
  // The start of a frame in /spins, its strides and its extents.
  std::string numbers;
  std::istringstream last(text.substr(text.rfind("Format=\"XML\">") + 13));
  for (std::string word; last >> word && word.front() != '<';) numbers += word + ' ';
  EXPECT_EQ(numbers, "2 0 0 0 0 1 1 1 1 1 1 2 3 4 3 ");
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
