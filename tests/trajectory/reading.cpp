// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hdf5/dataset.hpp"
#include "trajectory_test.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <numeric>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

// Writes a file with one dataset, as another program would.
void write_file(fs::path const& path, char const* name, Extents const& extents,
                hid_t type = H5T_IEEE_F64LE) {
  FileHandle const file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  std::vector<double> values(elements(extents));
  std::iota(values.begin(), values.end(), 0.0);
  write_dataset(file.get(), name, type, H5T_NATIVE_DOUBLE, extents, values.data(), path);
}

constexpr std::array<std::int64_t, 3> row{4, 1, 1};

TEST_F(TrajectoryTest, SpinsOfOneState) {
  auto const path = folder_ / "state.h5";
  write_file(path, "spins", {2, 3, 4, 3}, H5T_IEEE_F32LE);
  std::vector<double> expected(72);
  std::iota(expected.begin(), expected.end(), 0.0);
  EXPECT_EQ(read_spins(path, {4, 3, 2}), expected);
}

TEST_F(TrajectoryTest, SpinsOfTheLastFrame) {
  auto const path = folder_ / "state.h5";
  write_file(path, "spins", {5, 1, 1, 4, 3});
  std::vector<double> expected(12);
  std::iota(expected.begin(), expected.end(), 48.0);
  EXPECT_EQ(read_spins(path, row), expected);
}

TEST_F(TrajectoryTest, SpinsOfOneFrame) {
  auto const path = folder_ / "frames.h5";
  write_frames(path, 3).finish({});
  auto const shape = small_header().shape;
  for (int frame = 0; frame < 3; ++frame)
    EXPECT_EQ(read_spins(path, shape, frame), numbered_spins<double>(small_header(), frame));
  for (int const frame : {-1, 3})
    EXPECT_TRUE(contains(error_line(path, [&] { read_spins(path, shape, frame); }),
                         "it has no frame " + std::to_string(frame) + "; accepted: 0 to 2"));
  auto const state = folder_ / "state.h5";
  write_file(state, "spins", {1, 1, 4, 3});
  EXPECT_TRUE(contains(error_line(state, [&] { read_spins(state, row, 0); }), "it has no frames"));
}

TEST_F(TrajectoryTest, SpinsOfAnotherShape) {
  auto const path = folder_ / "state.h5";
  for (auto const& extents :
       {Extents{4, 3}, {1, 1, 4, 2}, {4, 1, 1, 3}, {3}, {2, 2, 1, 1, 4, 3}, {}}) {
    write_file(path, "spins", extents);
    auto const message = error_line(path, [&] { read_spins(path, row); });
    EXPECT_TRUE(contains(message, "accepted: (1, 1, 4, 3) or (frame, 1, 1, 4, 3)"));
  }
  write_file(path, "spins", {0, 1, 1, 4, 3});
  EXPECT_TRUE(contains(error_line(path, [&] { read_spins(path, row); }), "no frame"));
}

TEST_F(TrajectoryTest, SpinsThatAreNotNumbersOrNotThere) {
  auto const path = folder_ / "state.h5";
  write_file(path, "spins", {1, 1, 4, 3}, H5T_STD_I32LE);
  EXPECT_TRUE(contains(error_line(path, [&] { read_spins(path, row); }), "neither float"));
  write_file(path, "other", {1, 1, 4, 3});
  EXPECT_TRUE(contains(error_line(path, [&] { read_spins(path, row); }), "spins: it is not there"));
}

TEST_F(TrajectoryTest, MagnetizationOfAnotherMakerDoesNotCountFrames) {
  auto const path = folder_ / "state.h5";
  write_file(path, "spins", {5, 1, 1, 4, 3});
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    create_dataset(file.get(), "magnetization", H5T_IEEE_F64LE, {2}, path);
  }
  EXPECT_EQ(read_spins(path, row).at(0), 48);
}

TEST_F(TrajectoryTest, FileThatIsNone) {
  auto const missing = folder_ / "missing.h5";
  EXPECT_TRUE(contains(error_line(missing, [&] { read_info(missing); }), "No such file"));
  auto const text = folder_ / "text.h5";
  write_bytes(text, "not a trajectory\n");
  EXPECT_TRUE(contains(error_line(text, [&] { read_info(text); }), "not an HDF5 file"));
  EXPECT_TRUE(contains(error_line(text, [&] { read_spins(text, row); }), "not an HDF5 file"));
  auto const pipe = folder_ / "pipe.h5";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_TRUE(contains(error_line(pipe, [&] { read_info(pipe); }), "not a regular file"));
  auto const other = folder_ / "other.h5";
  write_file(other, "spins", {1, 1, 4, 3});
  EXPECT_TRUE(contains(error_line(other, [&] { read_info(other); }), "attribute format"));
}

TEST_F(TrajectoryTest, FileBeingWritten) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 1).finish({});
  int const writer = ::open(path.c_str(), O_RDWR);
  ASSERT_EQ(::flock(writer, LOCK_EX), 0);
  EXPECT_TRUE(contains(error_line(path, [&] { read_info(path); }), "another program"));
  ::close(writer);
}

TEST_F(TrajectoryTest, TruncatedFile) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 100).finish({});
  auto const size = fs::file_size(path);
  for (auto const kept : {size - 1, size / 2, std::uintmax_t{600}, std::uintmax_t{4}}) {
    fs::resize_file(path, kept);
    error_line(path, [&] { read_info(path); });
    error_line(path, [&] { read_spins(path, small_header().shape); });
  }
}

TEST_F(TrajectoryTest, Hdf5KeepsPrintingItsErrorsForOthers) {
  H5E_auto2_t before = nullptr, after = nullptr;
  void* data = nullptr;
  H5Eget_auto2(H5E_DEFAULT, &before, &data);
  testing::internal::CaptureStderr();
  auto const path = folder_ / "missing.h5";
  error_line(path, [&] { read_info(path); });
  EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
  H5Eget_auto2(H5E_DEFAULT, &after, &data);
  EXPECT_EQ(before, after);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
