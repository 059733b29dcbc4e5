// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Files of runs that end in different ways.
#include "hdf5/handle.hpp"
#include "trajectory_test.hpp"

#include <array>
#include <csignal>

namespace cayspin::inline v0_2::io {
namespace {

TEST_F(TrajectoryTest, InterruptedRunIsNotComplete) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 2).close({7, 2, 1});
  auto const info = read_info(path);
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 2);
  EXPECT_EQ(info.cost.evaluations, 7);
  EXPECT_EQ(info.cost.wall_seconds, 2);
  EXPECT_EQ(info.cost.step_seconds, 1);
}

TEST_F(TrajectoryTest, RunThatNeverEndsIsNotComplete) {
  auto const path = folder_ / "a.h5";
  { auto const file = write_frames(path, 2); }
  auto const info = read_info(path);
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 2);
}

TEST_F(TrajectoryTest, ReservedRoomIsGivenBack) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 2).finish({});
  EXPECT_LT(std::filesystem::file_size(path), 300000u);
}

// The spins of 100 frames are in 15 chunks.
TEST_F(TrajectoryTest, KilledRunLeavesWholeFrames) {
  auto const path = folder_ / "a.h5";
  auto const die = [&] {
    auto file = write_frames(path, 100);
    file.write_scalars(1000, 10, {});
    std::raise(SIGKILL);
  };
  EXPECT_EXIT(die(), testing::KilledBySignal(SIGKILL), "");
  auto const info = read_info(path);
  EXPECT_FALSE(info.complete);
  EXPECT_EQ(info.frames, 100);
  EXPECT_EQ(info.frame_steps.back(), 990);
  EXPECT_EQ(info.samples, 100);
  EXPECT_EQ(read_spins(path, small_header().shape), numbered_spins<double>(small_header(), 99));
}

TEST_F(TrajectoryTest, FrameWithoutItsScalarsDoesNotCount) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 2).close({});
  {
    FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    DatasetHandle const spins(H5Dopen2(file.get(), "/spins", H5P_DEFAULT));
    std::array<hsize_t, 5> const torn{3, 2, 3, 4, 3};
    ASSERT_GE(H5Dset_extent(spins.get(), torn.data()), 0);
  }
  EXPECT_EQ(read_info(path).frames, 2);
  EXPECT_EQ(read_spins(path, small_header().shape), numbered_spins<double>(small_header(), 1));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
