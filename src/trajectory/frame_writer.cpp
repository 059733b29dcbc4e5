// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "frame_writer.hpp"

#include "format.hpp"
#include "hdf5/error.hpp"

#include <algorithm>
#include <bit>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_1::io {
namespace {

// Without HDF5's filters a frame is written alone into its chunk, whose other frames keep their
// bytes.
std::array<hsize_t, 5> chunk_of(std::array<std::int64_t, 3> const& shape, std::size_t number_bytes,
                                TrajectoryStorage const& storage) {
  auto chunk = frame_chunk(shape, number_bytes, storage.chunk);
  if (storage.compression > 0) return chunk;
  std::int64_t chunks = storage.frames;
  for (int axis = 0; axis < 3; ++axis) {
    auto const of_chunk = static_cast<std::int64_t>(chunk[3 - axis]);
    chunks *= (shape[axis] + of_chunk - 1) / of_chunk;
  }
  chunk[0] = static_cast<hsize_t>(
      frames_of_chunk(3 * number_bytes * chunk[1] * chunk[2] * chunk[3], chunks));
  return chunk;
}

// A frame that never reached the disk reads as NaN, not as zeros.
DatasetHandle create_spins(hid_t file, TrajectoryHeader const& header,
                           TrajectoryStorage const& storage, std::array<hsize_t, 5> const& chunk,
                           std::filesystem::path const& path) {
  bool const single = header.precision == single_precision;
  std::array<hsize_t, 4> inner{0, 0, 0, 3};
  for (int axis = 0; axis < 3; ++axis) inner[2 - axis] = static_cast<hsize_t>(header.shape[axis]);
  PropertyHandle properties(H5Pcreate(H5P_DATASET_CREATE));
  auto const missing = std::numeric_limits<double>::quiet_NaN();
  check(H5Pset_fill_value(properties.get(), H5T_NATIVE_DOUBLE, &missing), path,
        "cannot create dataset spins");
  if (storage.compression > 0) {
    check(H5Pset_shuffle(properties.get()), path, "cannot create dataset spins");
    check(H5Pset_deflate(properties.get(), static_cast<unsigned>(storage.compression)), path,
          "cannot create dataset spins");
  }
  return create_growing_dataset(file, "spins", single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE, chunk,
                                std::move(properties), path, inner);
}

// Chunks of whole planes of one frame, as they lie in memory.
bool written_raw(std::array<std::int64_t, 3> const& shape, std::array<hsize_t, 5> const& chunk,
                 TrajectoryStorage const& storage) {
  return std::endian::native == std::endian::little && storage.compression == 0 && chunk[0] == 1 &&
         chunk[2] == static_cast<hsize_t>(shape[1]) && chunk[3] == static_cast<hsize_t>(shape[0]);
}

}  // namespace

FramePieces frame_pieces(std::array<std::int64_t, 3> const& shape, std::size_t number_bytes,
                         TrajectoryStorage const& storage, std::int64_t most_planes) {
  auto const chunk = chunk_of(shape, number_bytes, storage);
  auto const of_chunk = static_cast<std::int64_t>(chunk[1]);
  auto const plane_bytes = 3 * number_bytes * static_cast<std::size_t>(shape[0] * shape[1]);
  std::int64_t const most = most_planes > 0 ? std::min(most_planes, shape[2]) : shape[2];
  std::int64_t const chunks = most == shape[2] ? (most + of_chunk - 1) / of_chunk
                                               : std::max<std::int64_t>(1, most / of_chunk);
  auto const room = plane_bytes * static_cast<std::size_t>(chunks * of_chunk);
  auto const of_chunk_bytes = 3 * number_bytes * chunk[0] * chunk[1] * chunk[2] * chunk[3];
  return {.planes = std::min(chunks * of_chunk, shape[2]),
          .bytes = room,
          .copied = written_raw(shape, chunk, storage) ? 0 : 2 * of_chunk_bytes};
}

FrameWriter::FrameWriter(hid_t file, TrajectoryHeader const& header,
                         TrajectoryStorage const& storage, std::filesystem::path path)
    : path_(std::move(path)),
      shape_(header.shape),
      number_bytes_(header.precision == single_precision ? sizeof(float) : sizeof(double)),
      plane_bytes_(3 * number_bytes_ * static_cast<std::size_t>(shape_[0] * shape_[1])) {
  chunk_ = chunk_of(shape_, number_bytes_, storage);
  dataset_ = create_spins(file, header, storage, chunk_, path_);
  raw_ = written_raw(shape_, chunk_, storage);
}

std::uint64_t FrameWriter::frame_bytes() const {
  return plane_bytes_ * static_cast<std::uint64_t>(shape_[2]) * chunk_[0];
}

void FrameWriter::begin(std::int64_t frame) {
  frame_ = frame;
  planes_ = 0;
  checksum_ = {};
}

void FrameWriter::require_planes(std::int64_t planes) const {
  auto const left = shape_[2] - planes_, of_chunk = static_cast<std::int64_t>(chunk_[1]);
  if (planes == left || (planes > 0 && planes < left && planes % of_chunk == 0)) return;
  throw std::logic_error(path_.string() + ": " + std::to_string(planes) + " planes of " +
                         std::to_string(left) + " that are left; accepted: whole chunks, of " +
                         std::to_string(of_chunk));
}

void FrameWriter::add(std::int64_t planes, void const* spins) {
  require_planes(planes);
  append_block(dataset_.get(),
               number_bytes_ == sizeof(float) ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
               place(planes_),
               {1, static_cast<hsize_t>(planes), static_cast<hsize_t>(shape_[1]),
                static_cast<hsize_t>(shape_[0]), 3},
               spins, path_);
  checksum_.add(static_cast<std::byte const*>(spins),
                plane_bytes_ * static_cast<std::size_t>(planes));
  planes_ += planes;
}

void FrameWriter::add_in_room(std::int64_t planes, std::byte* spins) {
  if (!raw_) return add(planes, spins);
  require_planes(planes);
  add_raw(planes, spins);
}

// HDF5 would copy each chunk.
void FrameWriter::add_raw(std::int64_t planes, std::byte* spins) {
  if (planes_ == 0) grow(dataset_.get(), static_cast<hsize_t>(frame_) + 1, path_);
  auto const of_chunk = static_cast<std::int64_t>(chunk_[1]);
  auto const chunk_bytes = plane_bytes_ * chunk_[1];
  for (std::int64_t begin = 0; begin < planes; begin += of_chunk) {
    auto const bytes = plane_bytes_ * static_cast<std::size_t>(std::min(of_chunk, planes - begin));
    auto* const chunk = spins + plane_bytes_ * static_cast<std::size_t>(begin);
    std::fill(chunk + bytes, chunk + chunk_bytes, std::byte{0});
    checksum_.add(chunk, bytes);
    write_raw_chunk(dataset_.get(), place(planes_ + begin), chunk, chunk_bytes, path_);
  }
  planes_ += planes;
}

Extents FrameWriter::place(std::int64_t plane) const {
  return {static_cast<hsize_t>(frame_), static_cast<hsize_t>(plane), 0, 0, 0};
}

}  // namespace cayspin::inline v0_1::io
