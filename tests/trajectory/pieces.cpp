// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Frames and fields too large for memory are written plane by plane, and read by boxes.
#include "hdf5/handle.hpp"
#include "io/checkpoint.hpp"
#include "io/run_output.hpp"
#include "trajectory/fletcher32.hpp"
#include "trajectory/frame_writer.hpp"
#include "trajectory_test.hpp"

#include <algorithm>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::array<std::int64_t, 3> odd_shape{4, 3, 7};
constexpr SiteBox boxes[] = {
    {{0, 0, 0}, odd_shape}, {{0, 1, 2}, {4, 2, 3}}, {{1, 0, 6}, {2, 3, 1}}};

TrajectoryHeader odd_header(std::string const& precision = "double") {
  auto header = small_header(precision);
  header.shape = odd_shape;
  return header;
}

CheckpointHeader of_odd_run() {
  CheckpointHeader header;
  header.shape = odd_shape;
  return header;
}

template <class Real>
void write_in_pieces(std::filesystem::path const& path, RunOutputOptions const& options) {
  auto const header = odd_header(sizeof(Real) == sizeof(float) ? "single" : "double");
  auto const pieces = frame_pieces(odd_shape, sizeof(Real), options.storage, options.most_planes);
  RunOutput output(path, header, options);
  for (int frame = 0; frame < 3; ++frame) {
    auto const spins = numbered_spins<Real>(header, frame);
    constexpr std::int64_t of_plane = 3 * odd_shape[0] * odd_shape[1];
    for (std::int64_t first = 0; first < odd_shape[2]; first += pieces.planes) {
      auto const planes = std::min(pieces.planes, odd_shape[2] - first);
      std::copy_n(spins.begin() + first * of_plane, planes * of_plane,
                  output.template frame<Real>());
      if (first + planes < odd_shape[2])
        output.write_piece();
      else
        output.write_frame(frame, frame, numbered_scalars(frame));
    }
  }
  output.finish({});
}

template <class Real>
void expect_whole(std::filesystem::path const& path) {
  auto const header = odd_header();
  ASSERT_EQ(read_info(path).frames, 3);
  for (int frame = 0; frame < 3; ++frame) {
    auto const spins = numbered_spins<Real>(header, frame);
    std::vector<double> const expected(spins.begin(), spins.end());
    EXPECT_EQ(read_spins(path, odd_shape, frame), expected);
    if (frame < 2) continue;
    for (auto const& box : boxes)
      EXPECT_EQ(read_spins(path, odd_shape, box), numbers_in(box, odd_shape, 3, expected));
  }
}

TEST_F(TrajectoryTest, FramesInPiecesAreWhole) {
  auto const path = folder_ / "a.h5";
  for (int const compression : {0, 1})
    for (std::int64_t const chunk : {0, 1, 3, 9})
      for (std::int64_t const most : {0, 1, 6}) {
        SCOPED_TRACE("chunk " + std::to_string(chunk) + ", at most " + std::to_string(most) +
                     " planes, compression " + std::to_string(compression));
        RunOutputOptions const options{.overwrite = true,
                                       .storage = {.compression = compression, .chunk = chunk},
                                       .most_planes = most};
        write_in_pieces<double>(path, options);
        expect_whole<double>(path);
        write_in_pieces<float>(path, options);
        expect_whole<float>(path);
      }
}

TEST_F(TrajectoryTest, PiecesAreWholeChunks) {
  auto const planes = [](std::int64_t chunk, std::int64_t most) {
    return frame_pieces(odd_shape, 8, {.chunk = chunk}, most).planes;
  };
  EXPECT_EQ(planes(0, 0), 7);
  EXPECT_EQ(planes(0, 3), 7);
  EXPECT_EQ(planes(2, 0), 7);
  EXPECT_EQ(planes(2, 5), 4);
  EXPECT_EQ(planes(2, 1), 2);
  EXPECT_EQ(planes(1, 3), 3);
  EXPECT_EQ(planes(3, 9), 7);
  constexpr std::size_t plane_bytes = 3 * 8 * 4 * 3;
  auto const last_is_short = frame_pieces(odd_shape, 8, {.chunk = 2});
  EXPECT_EQ(last_is_short.bytes, 8 * plane_bytes);
  // A chunk holds two planes of each of 7 frames: about a page.
  EXPECT_EQ(last_is_short.copied, 2 * 7 * 2 * plane_bytes);
  EXPECT_EQ(frame_pieces({64, 32, 7}, 8, {}).copied, 0U);
  EXPECT_EQ(frame_pieces(odd_shape, 8, {.compression = 1, .chunk = 2}).copied, 2 * 2 * plane_bytes);
}

// A plane of more than 256 MiB is cut along y, here into three chunks of 11 rows.
TEST_F(TrajectoryTest, SpaceIsReservedForWholeChunksOfACutPlane) {
  auto header = small_header();
  header.shape = {1'000'000, 31, 1};
  auto const path = folder_ / "a.h5";
  FileHandle const file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  EXPECT_GE(FrameWriter(file.get(), header, {}, path).frame_bytes(), 3 * 11 * 24'000'000U);
}

TEST_F(TrajectoryTest, PiecesOutOfOrderAreRefused) {
  RunOutput output(folder_ / "a.h5", odd_header(), {.storage = {.chunk = 3}, .most_planes = 3});
  EXPECT_THROW(output.write_piece(), std::logic_error);
  output.frame<double>();
  EXPECT_THROW(output.write_frame(0, 0, {}), std::logic_error);
  output.write_piece();
  output.frame<double>();
  output.write_piece();
  output.frame<double>();
  EXPECT_THROW(output.write_piece(), std::logic_error);
  output.write_frame(0, 0, {});
  output.finish({});
  EXPECT_EQ(read_info(folder_ / "a.h5").frames, 1);

  TrajectoryFile file(folder_ / "b.h5", odd_header(), false, {.chunk = 3});
  std::vector<std::byte> room(frame_pieces(odd_shape, 8, {.chunk = 3}).bytes);
  for (std::int64_t const planes : {-3, 0, 1, 2, 4, 5, 8, 9})
    EXPECT_THROW(file.write_planes(planes, room.data()), std::logic_error) << planes;
  EXPECT_THROW(file.end_frame(0, 0, {}), std::logic_error);
  file.write_planes(6, room.data());
  EXPECT_THROW(file.end_frame(0, 0, {}), std::logic_error);
  file.write_planes(1, room.data());
  file.end_frame(0, 0, {});
  EXPECT_EQ(file.frames(), 1);
}

// In a run that ends within a frame, only the earlier frames count.
TEST_F(TrajectoryTest, FramesThatWereNotEndedDoNotCount) {
  auto const path = folder_ / "a.h5";
  {
    RunOutput output(path, odd_header(), {.storage = {.chunk = 2}, .most_planes = 2});
    auto const spins = numbered_spins<double>(odd_header(), 0);
    for (int piece = 0; piece < 6; ++piece) {
      std::copy_n(spins.begin() + 72 * (piece % 4), piece % 4 == 3 ? 36 : 72,
                  output.frame<double>());
      piece == 3 ? output.write_frame(0, 0, {}) : output.write_piece();
    }
  }
  EXPECT_EQ(read_info(path).frames, 1);
  EXPECT_EQ(read_spins(path, odd_shape), numbered_spins<double>(odd_header(), 0));
}

TEST_F(TrajectoryTest, ABoxIsRefusedWhenItsFrameIsDamagedElsewhere) {
  auto const path = folder_ / "a.h5";
  write_in_pieces<double>(path, {.storage = {.chunk = 1}});
  auto const spins = numbered_spins<double>(odd_header(), 2);
  auto const at = read_bytes(path).rfind(bytes_of(spins[spins.size() - 36]));
  ASSERT_NE(at, std::string::npos);
  overwrite(path, at, "\1");
  EXPECT_THROW(read_spins(path, odd_shape, SiteBox{{0, 0, 0}, {4, 3, 1}}), std::runtime_error);
}

TEST(Fletcher, OfPiecesIsThatOfAll) {
  std::vector<std::byte> bytes(2 * 3'000'001);
  for (std::size_t i = 0; i < bytes.size(); ++i) bytes[i] = static_cast<std::byte>(i * i >> 3U);
  for (std::size_t const cut : {0, 2, 131'070, 4'000'000, 6'000'002}) {
    Fletcher32 sum;
    sum.add(std::span(bytes).first(cut));
    sum.add(std::span(bytes).subspan(cut));
    EXPECT_EQ(sum.value(), fletcher32(bytes)) << cut;
  }
}

TEST_F(TrajectoryTest, CheckpointsByPlanesAreThoseOfFields) {
  auto header = odd_header();
  auto numbers = numbered_spins<double>(header, 1);
  for (std::int64_t const planes : {1, 2, 7}) {
    auto const path = folder_ / (std::to_string(planes) + ".checkpoint.h5");
    CheckpointWriter writer(path, of_odd_run());
    for (std::string const name : {"spins", "other"})
      for (std::int64_t first = 0; first < 7; first += planes) {
        auto const begin = numbers.begin() + 36 * first;
        writer.planes(name, 3, {begin, begin + 36 * std::min(planes, 7 - first)});
      }
    writer.commit();
    CheckpointReader const reader(path);
    for (auto const& box : boxes)
      EXPECT_EQ(reader.field("other", box), numbers_in(box, odd_shape, 3, numbers));
  }
}

TEST_F(TrajectoryTest, FieldsOfACheckpointAreNotMixedOrCutShort) {
  CheckpointWriter writer(folder_ / "a.checkpoint.h5", of_odd_run());
  std::vector<double> const plane(36, 0.5), row(12, 0.5);
  EXPECT_THROW(writer.planes("spins", 3, row), std::invalid_argument);
  EXPECT_THROW(writer.planes("spins", 4, plane), std::invalid_argument);
  EXPECT_THROW(writer.planes("spins", 3, {}), std::invalid_argument);
  writer.planes("spins", 3, plane);
  EXPECT_THROW(writer.planes("other", 3, plane), std::logic_error);
  EXPECT_THROW(writer.planes("spins", 1, plane), std::logic_error);
  EXPECT_THROW(writer.planes("spins", 3, std::vector<double>(36 * 7)), std::logic_error);
  EXPECT_THROW(writer.commit(), std::logic_error);
  for (int k = 1; k < 7; ++k) writer.planes("spins", 3, plane);
  writer.commit();
  CheckpointReader const reader(folder_ / "a.checkpoint.h5");
  EXPECT_EQ(reader.field("spins", {{0, 0, 3}, {4, 3, 1}}), plane);
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
