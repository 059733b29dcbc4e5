// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Detection of damaged files.
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/guarded_reading.hpp"
#include "hdf5/handle.hpp"
#include "io/checkpoint.hpp"
#include "program/read_in_child.hpp"
#include "trajectory/checksum.hpp"
#include "trajectory/fletcher32.hpp"
#include "trajectory_test.hpp"

#include <sys/wait.h>

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <csignal>
#include <cstring>
#include <span>
#include <thread>

namespace cayspin::inline v0_2::io {
namespace {

TEST(Checksum, DependsOnEveryNumberAndIsNeverZero) {
  Sample const sample{3, 0.5, {-1, 1e-16, {0.1, 0.2, 0.3}}};
  auto const row = row_checksum(sample);
  std::array<double, 7> numbers{};
  static_assert(sizeof numbers == sizeof sample);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    std::memcpy(numbers.data(), &sample, sizeof sample);
    numbers[i] += 1;
    auto const other = std::bit_cast<Sample>(numbers);
    EXPECT_NE(row_checksum(other), row) << i;
    EXPECT_NE(spins_checksum(other, 7), spins_checksum(sample, 7)) << i;
  }
  EXPECT_NE(row, 0u);
  EXPECT_NE(row_checksum(Sample{}), 0u);
  EXPECT_NE(spins_checksum(Sample{}, 0), 0u);
  EXPECT_NE(spins_checksum(sample, 8), spins_checksum(sample, 7));
}

// Numbers computed from the definition outside cayspin. With other checksums, files written before
// could not be read.
TEST(Checksum, IsThatOfFilesWrittenBefore) {
  Sample const sample{3, 0.5, {-1, 1e-16, {0.1, 0.2, 0.3}}};
  EXPECT_EQ(row_checksum(sample), 0xb109a328U);
  EXPECT_EQ(row_checksum(sample, std::array{0.25, -2.0}), 0x04bc10f8U);
  EXPECT_EQ(spins_checksum(sample, 7), 0x5d82921dU);
}

TEST(Fletcher, IsTheSumOfWordsAndOfTheirSums) {
  auto const sum = [](std::string const& bytes) {
    return fletcher32(std::as_bytes(std::span(bytes)));
  };
  EXPECT_EQ(sum(std::string(4, '\0')), 0U);
  EXPECT_EQ(sum({'\0', '\1', '\0', '\2'}), 0x00040003U);  // the words 1 and 2
  EXPECT_EQ(sum(std::string(1U << 22U, '\xff')), 0xffffffffU);
}

// HDF5's filter appends the sum to a chunk. There are more than 2^20 words, after which Fletcher32
// first reduces its sums.
TEST_F(TrajectoryTest, FletcherIsThatOfHdf5) {
  auto const path = folder_ / "a.h5";
  std::string mixed(4'000'002, '\0');
  for (std::size_t i = 0; i < mixed.size(); ++i) mixed[i] = static_cast<char>(i * i >> 3U);
  for (auto const& bytes : {mixed, std::string(mixed.size(), '\xff')}) {
    {
      FileHandle const file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
      PropertyHandle const properties(H5Pcreate(H5P_DATASET_CREATE));
      hsize_t const size = bytes.size();
      ASSERT_GE(H5Pset_chunk(properties.get(), 1, &size), 0);
      ASSERT_GE(H5Pset_fletcher32(properties.get()), 0);
      write_dataset(file.get(), "bytes", H5T_STD_U8LE, H5T_NATIVE_UINT8, {size}, bytes.data(), path,
                    properties.get());
    }
    std::uint32_t const sum = fletcher32(std::as_bytes(std::span(bytes)));
    std::string appended(sizeof sum, '\0');
    std::memcpy(appended.data(), &sum, sizeof sum);
    EXPECT_NE(read_bytes(path).find(bytes + appended), std::string::npos) << sum;
  }
}

TEST_F(TrajectoryTest, ZeroedFrameIsNoticed) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 3).finish({});
  auto const shape = small_header().shape;
  auto const place = read_bytes(path).find(bytes_of(numbered_spins<double>(small_header(), 1)[0]));
  ASSERT_NE(place, std::string::npos);
  overwrite(path, place, std::string(72 * sizeof(double), '\0'));
  EXPECT_TRUE(contains(error_line(path, [&] { read_spins(path, shape, 1); }),
                       "frame 1 is damaged: its checksum differs"));
  EXPECT_EQ(read_spins(path, shape), numbered_spins<double>(small_header(), 2));
  EXPECT_EQ(read_info(path).frames, 3);
}

TEST_F(TrajectoryTest, ChangedScalarOfAFrameIsNoticed) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 3).finish({});
  auto const place = read_bytes(path).rfind(bytes_of(numbered_scalars(1).energy));
  ASSERT_NE(place, std::string::npos);
  overwrite(path, place, "\1");
  EXPECT_TRUE(contains(error_line(path, [&] { read_info(path); }), "its checksum differs"));
}

TEST_F(TrajectoryTest, ChangedSceneIsNoticed) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 1).finish({});
  overwrite(path, read_bytes(path).find("kind = \"llg\""), "kinD");
  EXPECT_TRUE(contains(error_line(path, [&] { read_info(path); }), "its attributes are damaged"));
}

// No checksum covers the units, so a change is noticed only if it makes the word invalid.
TEST_F(TrajectoryTest, ChangedUnitsAreNoticed) {
  auto const path = folder_ / "a.h5";
  auto header = small_header();
  header.units = {.si = true, .time = 1e-12, .length = 1e-9, .field = 1, .energy = 1e-20};
  TrajectoryFile(path, header, false).finish({});
  ASSERT_TRUE(read_info(path).header.units.si);
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    ASSERT_GE(H5Adelete(file.get(), "units"), 0);
    RootAttributes(file.get(), path).create("units", std::string("SX"));
  }
  EXPECT_TRUE(contains(error_line(path, [&] { read_info(path); }),
                       "cannot read attribute units: it is neither SI nor reduced"));
}

TEST_F(TrajectoryTest, FilesWithoutChecksumsAreRead) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 3).finish({});
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    for (auto const* name : {"checksum", "scalars/checksum"})
      ASSERT_GE(H5Ldelete(file.get(), name, H5P_DEFAULT), 0);
    ASSERT_GE(H5Adelete(file.get(), "text_checksum"), 0);
  }
  EXPECT_EQ(read_info(path).frame_scalars.at(1).energy, numbered_scalars(1).energy);
  EXPECT_EQ(read_spins(path, small_header().shape), numbered_spins<double>(small_header(), 2));
}

TEST_F(TrajectoryTest, AttributeOfSeveralValuesIsRefused) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 1).finish({});
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    ASSERT_GE(H5Adelete(file.get(), "threads"), 0);
    hsize_t const two = 2;
    DataspaceHandle const space(H5Screate_simple(1, &two, nullptr));
    AttributeHandle const threads(
        H5Acreate2(file.get(), "threads", H5T_STD_I64LE, space.get(), H5P_DEFAULT, H5P_DEFAULT));
    std::int64_t const values[] = {1, 1};
    ASSERT_GE(H5Awrite(threads.get(), H5T_NATIVE_INT64, values), 0);
  }
  EXPECT_TRUE(contains(error_line(path, [&] { read_info(path); }),
                       "cannot read attribute threads: it is not one value"));
}

// Numbers and fields of a checkpoint are all verified when it is opened.
TEST_F(TrajectoryTest, NumberOfACheckpointThatIsNoneIsRefused) {
  auto const path = folder_ / "a.checkpoint.h5";
  double number = 0.25;
  std::vector<double> spins(3);
  {
    CheckpointWriter writer(path, {});
    writer.number("a", number);
    writer.field("spins", spins);
    writer.commit();
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    GroupHandle const numbers(H5Gopen2(file.get(), "numbers", H5P_DEFAULT));
    ASSERT_GE(H5Adelete(numbers.get(), "a"), 0);
    RootAttributes(numbers.get(), path).create("a", std::string("a quarter"));
  }
  EXPECT_TRUE(contains(error_line(path, [&] { CheckpointReader reader(path); }),
                       "cannot read attribute a"));
}

// The numbers and their checksum stay as they are.
TEST_F(TrajectoryTest, ChangedShapeOfACheckpointIsNoticed) {
  auto const path = folder_ / "a.checkpoint.h5";
  std::vector<double> spins(18, 0.5);
  CheckpointHeader header;
  header.shape = {3, 2, 1};
  {
    CheckpointWriter writer(path, header);
    writer.field("spins", spins);
    writer.commit();
  }
  EXPECT_EQ(CheckpointReader(path).header().shape, header.shape);
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    DatasetHandle const before = open_dataset(file.get(), "spins", path);
    auto const sum = RootAttributes(before.get(), path).read_integer("checksum");
    ASSERT_GE(H5Ldelete(file.get(), "spins", H5P_DEFAULT), 0);
    auto const after = create_dataset(file.get(), "spins", H5T_IEEE_F64LE, {1, 3, 2, 3}, path);
    write_block(after.get(), H5T_NATIVE_DOUBLE, {0, 0, 0, 0}, {1, 3, 2, 3}, spins.data(), path);
    RootAttributes(after.get(), path).create("checksum", sum);
  }
  EXPECT_TRUE(contains(error_line(path, [&] { CheckpointReader reader(path); }),
                       "cannot read dataset spins: its extents are not those written"));
}

class CheckpointContents : public TrajectoryTest {
 protected:
  CheckpointContents() {
    CheckpointHeader header;
    header.scene_text = "a scene";
    header.step = 12;
    header.time = 0.5;
    CheckpointWriter writer(path_, header);
    double count = 3, dt = 0.25;
    writer.number("known", count);
    writer.number("dt", dt);
    std::vector<double> spins{1, 2, 3}, others{4, 5, 6};
    writer.field("spins", spins);
    writer.field("field_0", spins);
    writer.field("field_1", others);
    writer.commit();
  }

  template <class Change>
  void change(Change const& work) const {
    FileHandle const file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    GroupHandle const numbers(H5Gopen2(file.get(), "numbers", H5P_DEFAULT));
    work(file.get(), numbers.get());
  }
  void expect_refused(std::string const& what) const {
    EXPECT_TRUE(contains(error_line(path_, [&] { CheckpointReader reader(path_); }),
                         "its contents are not those written"))
        << what;
  }

  template <class Number>
  static void replace(hid_t parent, std::filesystem::path const& path, char const* name,
                      Number value) {
    ASSERT_GE(H5Adelete(parent, name), 0);
    RootAttributes(parent, path).create(name, value);
  }

  std::filesystem::path const path_ = folder_ / "a.checkpoint.h5";
};

TEST_F(CheckpointContents, ChangedNumberIsNoticed) {
  change([&](hid_t, hid_t numbers) { replace(numbers, path_, "known", 1000.0); });
  expect_refused("known");
}
TEST_F(CheckpointContents, ChangedStepIsNoticed) {
  change([&](hid_t file, hid_t) { replace(file, path_, "step", std::int64_t{13}); });
  expect_refused("step");
}
TEST_F(CheckpointContents, ChangedTimeIsNoticed) {
  change([&](hid_t file, hid_t) { replace(file, path_, "time", 0.75); });
  expect_refused("time");
}
TEST_F(CheckpointContents, ChangedSceneIsNoticed) {
  change([&](hid_t file, hid_t) { replace(file, path_, "scene", std::string("another")); });
  expect_refused("scene");
}
TEST_F(CheckpointContents, LostNumberIsNoticed) {
  change([](hid_t, hid_t numbers) { ASSERT_GE(H5Adelete(numbers, "dt"), 0); });
  expect_refused("dt");
}
TEST_F(CheckpointContents, FieldsThatChangedPlacesAreNoticed) {
  change([](hid_t file, hid_t) {
    auto const move = [&](char const* from, char const* to) {
      ASSERT_GE(H5Lmove(file, from, file, to, H5P_DEFAULT, H5P_DEFAULT), 0);
    };
    move("field_0", "between");
    move("field_1", "field_0");
    move("between", "field_1");
  });
  expect_refused("fields");
}

TEST_F(CheckpointContents, AreReadFromAFileOfAnEarlierVersion) {
  change([](hid_t file, hid_t) { ASSERT_GE(H5Adelete(file, "checksum"), 0); });
  CheckpointReader reader(path_);
  double known = 0;
  reader.number("known", known);
  EXPECT_EQ(known, 3);
  EXPECT_EQ(reader.header().step, 12);
}

// HDF5 would refuse a file whose superblock has version 3 after its writer was killed.
TEST_F(TrajectoryTest, HeadOfTheFileIsOfVersionTwo) {
  auto const path = folder_ / "a.h5";
  auto const file = write_frames(path, 1);
  EXPECT_EQ(read_bytes(path).at(8), 2);
}

using cayspin::program::try_in_child;

/// Reads are tried in a child process, as in the program.
class Guard : public testing::Test {
 protected:
  Guard() { set_trial(try_in_child); }
  ~Guard() override { set_trial(nullptr); }
};

std::string reason(void (*reading)()) {
  return error_line("damaged.h5", [&] { try_reading("damaged.h5", reading); });
}

TEST_F(Guard, TellsWhatAReadingDied) {
  EXPECT_TRUE(contains(reason([] { std::raise(SIGSEGV); }), "damaged (reading it ends with Seg"));
  EXPECT_TRUE(contains(reason([] { std::abort(); }), "damaged (reading it ends with Abort"));
  EXPECT_TRUE(contains(reason([] { ::_exit(0); }), "damaged (reading it fails)"));
  EXPECT_TRUE(contains(reason([] { throw std::bad_alloc(); }), "more memory than there is"));
  EXPECT_TRUE(contains(reason([] {
                         for (std::size_t volatile turns = 0;;) turns = turns + 1;
                       }),
                       "takes too long"));
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
  EXPECT_TRUE(contains(reason([] {
                         std::vector<char> const all(std::size_t{1} << 45U);
                         if (all.back() == 1) ::_exit(1);
                       }),
                       "more memory than there is"));
#endif
}

TEST_F(Guard, PassesOnWhatAReadingSays) {
  EXPECT_EQ(
      error_line("a.h5", [] { try_reading("a.h5", [] { throw std::runtime_error("a.h5: no"); }); }),
      "a.h5: no");
  EXPECT_EQ(read_guarded("a.h5", [] { return 7; }), 7);
}

TEST_F(Guard, LeavesNoChildAndNoOutput) {
  testing::internal::CaptureStderr();
  try_reading("a.h5", [] { std::fprintf(stderr, "not to be seen"); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
  std::signal(SIGCHLD, SIG_IGN);  // the system then keeps no status of children
  EXPECT_EQ(read_guarded("a.h5", [] { return 7; }), 7);
  EXPECT_TRUE(contains(reason([] { std::raise(SIGSEGV); }), "damaged (reading it fails)"));
  std::signal(SIGCHLD, SIG_DFL);
}

// A child that waits for an event that never comes uses no CPU time.
TEST_F(Guard, EndsAChildThatWaits) {
  auto const wait = [] { ::pause(); };
  EXPECT_TRUE(contains(
      error_line("damaged.h5",
                 [&] { try_in_child("damaged.h5", wait, std::chrono::milliseconds(200)); }),
      "damaged (reading it takes too long)"));
  EXPECT_EQ(::waitpid(-1, nullptr, WNOHANG), -1);
}

// HDF5 works in the child, whatever other threads do in HDF5 at the moment of the fork.
TEST_F(Guard, WaitsForOtherThreadsThatUseHdf5) {
  std::atomic<bool> done = false;
  std::thread other([&] {
    while (!done) {
      QuietErrors const turn;
      H5Tclose(H5Tcopy(H5T_C_S1));
    }
  });
  for (int i = 0; i < 50; ++i)
    EXPECT_EQ(read_guarded("a.h5", [] { return H5Tclose(H5Tcopy(H5T_C_S1)); }), 0);
  done = true;
  other.join();
}

TEST(NoTrial, ReadsOnceWithoutAChild) {
  int readings = 0;
  auto const parent = ::getpid();
  EXPECT_EQ(read_guarded("a.h5", [&] { return ++readings; }), 1);
  try_reading("a.h5", [&] { readings += ::getpid() == parent ? 1 : 0; });
  EXPECT_EQ(readings, 2);
  try_before("a.h5", [&] { ++readings; });
  EXPECT_EQ(readings, 2);
  EXPECT_TRUE(contains(
      error_line("a.h5", [] { read_guarded("a.h5", [] { throw std::bad_alloc(); }); }),
      "a.h5: cannot read the file: it is damaged (reading it takes more memory than there is)"));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
