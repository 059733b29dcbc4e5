// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The file as other tools see it, read by HDF5's own functions.
#include "hdf5/handle.hpp"
#include "trajectory/format.hpp"
#include "trajectory_test.hpp"

#include <limits>

namespace cayspin::inline v0_2::io {
namespace {

struct Layout {
  std::vector<hsize_t> extents, largest, chunk;
  std::vector<H5Z_filter_t> filters;
  H5T_class_t type;
  std::size_t bytes;
};

Layout layout_of(std::filesystem::path const& path, char const* name) {
  FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  DatasetHandle const dataset(H5Dopen2(file.get(), name, H5P_DEFAULT));
  DataspaceHandle const space(H5Dget_space(dataset.get()));
  DatatypeHandle const type(H5Dget_type(dataset.get()));
  PropertyHandle const properties(H5Dget_create_plist(dataset.get()));
  auto const rank = H5Sget_simple_extent_ndims(space.get());
  EXPECT_GT(rank, 0) << name;
  Layout layout;
  layout.extents.resize(rank);
  layout.largest.resize(rank);
  layout.chunk.resize(rank);
  H5Sget_simple_extent_dims(space.get(), layout.extents.data(), layout.largest.data());
  H5Pget_chunk(properties.get(), rank, layout.chunk.data());
  for (int i = 0; i < H5Pget_nfilters(properties.get()); ++i) {
    unsigned flags = 0, parameters = 0;
    std::size_t count = 0;
    layout.filters.push_back(
        H5Pget_filter2(properties.get(), i, &flags, &count, nullptr, 0, nullptr, &parameters));
  }
  layout.type = H5Tget_class(type.get());
  layout.bytes = H5Tget_size(type.get());
  return layout;
}

using Sizes = std::vector<hsize_t>;
constexpr hsize_t unlimited = H5S_UNLIMITED;

TEST_F(TrajectoryTest, SpinsAreInChunksOfAPageOrMore) {
  for (std::string const precision : {"single", "double"}) {
    auto const path = folder_ / (precision + ".h5");
    auto const header = small_header(precision);
    TrajectoryFile file(path, header, false);
    for (int frame = 0; frame < 3; ++frame) {
      if (precision == "single")
        file.write_frame(0, 0, {}, numbered_spins<float>(header, 0).data());
      else
        file.write_frame(0, 0, {}, numbered_spins<double>(header, 0).data());
    }
    file.finish({});
    auto const spins = layout_of(path, "/spins");
    EXPECT_EQ(spins.extents, (Sizes{3, 2, 3, 4, 3}));
    EXPECT_EQ(spins.largest, (Sizes{unlimited, 2, 3, 4, 3}));
    EXPECT_EQ(spins.chunk, (Sizes{precision == "single" ? 14U : 7U, 2, 3, 4, 3}));
    EXPECT_TRUE(spins.filters.empty());
    EXPECT_EQ(spins.type, H5T_FLOAT);
    EXPECT_EQ(spins.bytes, precision == "single" ? 4u : 8u);
  }
}

// The state is uniform, so that compression is effective.
TEST_F(TrajectoryTest, SpinsAreCompressedAndCutWhereAsked) {
  auto header = small_header();
  header.shape = {64, 32, 10};
  std::vector<double> const spins(3 * 64 * 32 * 10, 0.5);
  auto const path = folder_ / "a.h5";
  TrajectoryFile file(path, header, false, {.compression = 4, .chunk = 3});
  file.write_frame(0, 0, {}, spins.data());
  file.finish({});
  auto const layout = layout_of(path, "/spins");
  EXPECT_EQ(layout.filters, (std::vector<H5Z_filter_t>{H5Z_FILTER_SHUFFLE, H5Z_FILTER_DEFLATE}));
  EXPECT_EQ(layout.chunk, (Sizes{1, 3, 32, 64, 3}));
  EXPECT_EQ(read_spins(path, header.shape), spins);
  EXPECT_LT(std::filesystem::file_size(path), sizeof(double) * spins.size() / 4);
}

TEST_F(TrajectoryTest, ChunksOfFramesLeaveLittleOfPagesEmpty) {
  constexpr std::int64_t page = file_page_bytes;
  for (std::int64_t bytes = 12; bytes < 20 * page; bytes += 12)
    for (std::int64_t const least : {0, 21}) {
      auto const frames = frames_of_chunk(static_cast<std::uint64_t>(bytes), least * most_chunks);
      auto const pages = (frames * bytes + page - 1) / page;
      EXPECT_GE(frames, least) << bytes;
      EXPECT_LE(16 * (pages * page - frames * bytes), pages * page) << bytes << ", " << least;
      EXPECT_LE(pages, 16 + (std::max(least, 1L) * bytes + page - 1) / page) << bytes;
    }
  EXPECT_EQ(frames_of_chunk(12 * page, most_chunks), 1);
  EXPECT_EQ(frames_of_chunk(12 * page, most_chunks + 1), 2);
  EXPECT_EQ(frames_of_chunk(1 << 20, 10 * most_chunks), 10);
  EXPECT_EQ(frames_of_chunk(most_chunk_bytes, 10 * most_chunks), 1);
}

// There can be at most `most_chunks` chunks. For that many frames of three planes, a chunk takes
// one plane from each of three frames.
TEST_F(TrajectoryTest, ManyPlannedFramesShareChunks) {
  auto header = small_header();
  header.shape = {32, 16, 3};  // three pages a plane
  auto const path = folder_ / "a.h5";
  for (auto const& [frames, of_chunk] : {std::pair{100, 1U}, {most_chunks, 3U}}) {
    TrajectoryFile file(path, header, true, {.chunk = 1, .frames = frames});
    file.close({});
    EXPECT_EQ(layout_of(path, "/spins").chunk, (Sizes{of_chunk, 1, 16, 32, 3})) << frames;
  }
}

TEST_F(TrajectoryTest, SmallFramesTakeLittleMoreThanTheirNumbers) {
  auto header = small_header();
  header.shape = {100, 1, 1};
  auto const path = folder_ / "a.h5";
  constexpr int frames = 2000;
  TrajectoryFile file(path, header, false);
  auto const spins = numbered_spins<double>(header, 0);
  for (int frame = 0; frame < frames; ++frame)
    file.write_frame(frame, 0.1 * frame, numbered_scalars(frame), spins.data());
  file.finish({});
  std::uintmax_t const numbers = frames * (100 * 3 + 8) * sizeof(double);
  EXPECT_LT(std::filesystem::file_size(path), numbers + numbers / 10);
  EXPECT_EQ(read_spins(path, header.shape, 1234), spins);
}

TEST_F(TrajectoryTest, ScalarsAreDoublesAndStepsAreIntegers) {
  auto const path = folder_ / "a.h5";
  write_frames(path, 2).finish({});
  for (std::string const group : {"/", "/scalars/"}) {
    for (std::string const name : {"time", "energy", "norm_defect"}) {
      auto const column = layout_of(path, (group + name).c_str());
      EXPECT_EQ(column.extents, Sizes{2}) << group << name;
      EXPECT_EQ(column.largest, Sizes{unlimited}) << group << name;
      EXPECT_EQ(column.type, H5T_FLOAT) << group << name;
      EXPECT_EQ(column.bytes, 8u) << group << name;
    }
    auto const step = layout_of(path, (group + "step").c_str());
    EXPECT_EQ(step.extents, Sizes{2});
    EXPECT_EQ(step.type, H5T_INTEGER);
    auto const magnetization = layout_of(path, (group + "magnetization").c_str());
    EXPECT_EQ(magnetization.extents, (Sizes{2, 3}));
    EXPECT_EQ(magnetization.largest, (Sizes{unlimited, 3}));
    EXPECT_EQ(magnetization.bytes, 8u);
  }
}

TEST_F(TrajectoryTest, EveryAttributeStandsFromTheFirstMoment) {
  auto const path = folder_ / "a.h5";
  { TrajectoryFile const file(path, small_header(), false); }
  FileHandle const file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  auto const class_of = [&](char const* name) {
    AttributeHandle const attribute(H5Aopen(file.get(), name, H5P_DEFAULT));
    DatatypeHandle const type(H5Aget_type(attribute.get()));
    return H5Tget_class(type.get());
  };
  for (auto const* name :
       {"scene", "cayspin_version", "git_commit", "kokkos_version", "space", "precision", "units"})
    EXPECT_EQ(class_of(name), H5T_STRING) << name;
  for (auto const* name : {"format", "threads", "evaluations", "complete"})
    EXPECT_EQ(class_of(name), H5T_INTEGER) << name;
  for (auto const* name : {"wall_seconds", "step_seconds"})
    EXPECT_EQ(class_of(name), H5T_FLOAT) << name;
  EXPECT_EQ(H5Aexists(file.get(), "resolved_scene"), 0);
  EXPECT_EQ(H5Aexists(file.get(), "time_unit"), 0);
}

TEST_F(TrajectoryTest, LongSceneIsKept) {
  auto const path = folder_ / "a.h5";
  auto header = small_header();
  header.scene_text = std::string(300000, 'x');
  TrajectoryFile(path, header, false).finish({});
  EXPECT_EQ(read_info(path).header.scene_text, header.scene_text);
}

// 2048 x 1024 x 100 spins in double are 4.7 GiB; a chunk has at most 256 MiB.
TEST_F(TrajectoryTest, FrameAboveTheChunkLimitIsSplit) {
  auto const path = folder_ / "a.h5";
  auto header = small_header();
  header.shape = {2048, 1024, 100};
  TrajectoryFile(path, header, false).finish({});
  auto const spins = layout_of(path, "/spins");
  EXPECT_EQ(spins.extents, (Sizes{0, 100, 1024, 2048, 3}));
  EXPECT_EQ(spins.chunk, (Sizes{1, 5, 1024, 2048, 3}));
}

TEST(FrameChunk, CutsTheSlowestAxisThatSuffices) {
  using Chunk = std::array<hsize_t, 5>;
  constexpr std::uint64_t site = 3 * 8;
  EXPECT_EQ(frame_chunk({5, 4, 3}, 8, 0, 60 * site), (Chunk{1, 3, 4, 5, 3}));
  EXPECT_EQ(frame_chunk({5, 4, 3}, 8, 0, 59 * site), (Chunk{1, 2, 4, 5, 3}));
  EXPECT_EQ(frame_chunk({5, 4, 3}, 8, 0, 39 * site), (Chunk{1, 1, 4, 5, 3}));
  EXPECT_EQ(frame_chunk({5, 4, 3}, 8, 0, 19 * site), (Chunk{1, 1, 2, 5, 3}));
  EXPECT_EQ(frame_chunk({5, 4, 3}, 8, 0, 4 * site), (Chunk{1, 1, 1, 3, 3}));
  EXPECT_EQ(frame_chunk({5, 4, 3}, 4, 0, 59 * site), (Chunk{1, 3, 4, 5, 3}));
}

TEST(FrameChunk, HoldsAtMostThePlanesAskedFor) {
  using Chunk = std::array<hsize_t, 5>;
  constexpr std::uint64_t site = 3 * 8;
  EXPECT_EQ(frame_chunk({5, 4, 3}, 8, 2), (Chunk{1, 2, 4, 5, 3}));
  EXPECT_EQ(frame_chunk({5, 4, 3}, 8, 7), (Chunk{1, 3, 4, 5, 3}));
  EXPECT_EQ(frame_chunk({5, 4, 3}, 8, 2, 39 * site), (Chunk{1, 1, 4, 5, 3}));
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
