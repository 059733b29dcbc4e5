// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Files of runs in stages: the stage of each frame, and the start of each stage.
#include "hdf5/dataset.hpp"
#include "hdf5/handle.hpp"
#include "io/checkpoint.hpp"
#include "io/run_output.hpp"
#include "trajectory_test.hpp"

#include <algorithm>

namespace cayspin::inline v0_2::io {
namespace {

class StagesOfFiles : public TrajectoryTest {
 protected:
  void write(std::optional<StageBegin> const& stage) const {
    auto header = small_header();
    header.stage = stage;
    RunOutput file(path_, header, {.overwrite = true});
    for (int frame = 0; frame < 4; ++frame) {
      std::ranges::copy(numbered_spins<double>(header, frame), file.frame<double>());
      file.write_frame(10 * frame, 0.1 * frame, numbered_scalars(frame),
                       {.stage = frame < 3 ? 2 : 5});
    }
    file.finish({});
  }

  std::filesystem::path path_ = folder_ / "a.h5";
};

TEST_F(StagesOfFiles, AreRead) {
  StageBegin const begin{2, -7, 1.0 / 3};
  write(begin);
  auto const info = read_info(path_);
  EXPECT_EQ(info.header.stage, begin);
  EXPECT_EQ(info.frame_stages, (std::vector<std::int64_t>{2, 2, 2, 5}));
  EXPECT_EQ(info.frame_steps.back(), 30);
  EXPECT_EQ(read_spins(path_, info.header.shape, 3), numbered_spins<double>(small_header(), 3));
}

TEST_F(StagesOfFiles, AreInNoOtherFile) {
  write(std::nullopt);
  auto const info = read_info(path_);
  EXPECT_FALSE(info.header.stage);
  EXPECT_TRUE(info.frame_stages.empty());
  FileHandle const file(H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  EXPECT_EQ(H5Lexists(file.get(), "stage", H5P_DEFAULT), 0);
}

TEST_F(StagesOfFiles, AreUnderTheChecksum) {
  write(StageBegin{2, 0, 0});
  {
    FileHandle const file(H5Fopen(path_.c_str(), H5F_ACC_RDWR, H5P_DEFAULT));
    std::int64_t const other = 4;
    write_block(open_dataset(file.get(), "stage", path_).get(), H5T_NATIVE_INT64, {3}, {1}, &other,
                path_);
  }
  EXPECT_TRUE(contains(error_line(path_, [&] { read_info(path_); }), "sample 3 is damaged"));
}

TEST_F(StagesOfFiles, AreInCheckpoints) {
  for (StageBegin const begin : {StageBegin{3, 25, 0.1 + 0.2}, StageBegin{}}) {
    std::vector<double> spins(3);
    {
      CheckpointHeader header;
      header.stage = begin;
      CheckpointWriter writer(path_, header);
      writer.field("spins", spins);
      writer.commit();
    }
    EXPECT_EQ(CheckpointReader(path_).header().stage, begin);
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
