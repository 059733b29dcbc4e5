// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "frame_writer.hpp"

#include "format.hpp"
#include "hdf5/error.hpp"
#include "sublattice_mean.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

using Shape = std::array<std::int64_t, 3>;

// Returns the shape of a block of the file, which holds one site of every cell.
Shape block_of(Shape shape, std::int64_t cell_sites) {
  shape[2] /= cell_sites;
  return shape;
}

// Returns the extents (frame, z, y, x, 3) of a chunk. With HDF5's filters, a chunk holds only one
// frame. Without them, it may hold several, because a frame is then written without changing the
// bytes of the others.
std::array<hsize_t, 5> chunk_of(Shape const& block, std::int64_t cell_sites,
                                std::size_t number_bytes, TrajectoryStorage const& storage) {
  auto chunk = frame_chunk(block, number_bytes, storage.chunk);
  if (storage.compression > 0) return chunk;
  std::int64_t chunks = storage.frames * cell_sites;
  for (int axis = 0; axis < 3; ++axis) {
    auto const of_chunk = static_cast<std::int64_t>(chunk[3 - axis]);
    chunks *= (block[axis] + of_chunk - 1) / of_chunk;
  }
  chunk[0] = static_cast<hsize_t>(
      frames_of_chunk(3 * number_bytes * chunk[1] * chunk[2] * chunk[3], chunks));
  return chunk;
}

// Returns the extents (frame, z, y, x, 3); for several sites per cell, inserts `sites` as the
// second one.
Extents with_site(std::array<hsize_t, 5> const& extents, std::int64_t cell_sites, hsize_t sites) {
  Extents all(extents.begin(), extents.end());
  if (cell_sites > 1) all.insert(all.begin() + 1, sites);
  return all;
}

// Creates /spins. Spins that never reached the disk are read as NaN, not as zeros.
DatasetHandle create_spins(hid_t file, TrajectoryHeader const& header,
                           TrajectoryStorage const& storage, std::array<hsize_t, 5> const& chunk,
                           std::filesystem::path const& path) {
  bool const single = header.precision == single_precision;
  auto const sites = header.cell_sites;
  auto const block = block_of(header.shape, sites);
  std::array<hsize_t, 5> extents{0, 0, 0, 0, 3};
  for (int axis = 0; axis < 3; ++axis) extents[3 - axis] = static_cast<hsize_t>(block[axis]);
  auto inner = with_site(extents, sites, static_cast<hsize_t>(sites));
  inner.erase(inner.begin());
  PropertyHandle properties(H5Pcreate(H5P_DATASET_CREATE));
  auto const missing = std::numeric_limits<double>::quiet_NaN();
  check(H5Pset_fill_value(properties.get(), H5T_NATIVE_DOUBLE, &missing), path,
        "cannot create dataset spins");
  if (storage.compression > 0) {
    check(H5Pset_shuffle(properties.get()), path, "cannot create dataset spins");
    check(H5Pset_deflate(properties.get(), static_cast<unsigned>(storage.compression)), path,
          "cannot create dataset spins");
  }
  return create_growing_dataset(file, "spins", single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE,
                                with_site(chunk, sites, 1), std::move(properties), path, inner);
}

// Returns true if memory holds the bytes of a chunk as the file stores them: if chunks are whole
// planes of one frame, uncompressed.
bool written_raw(Shape const& shape, std::array<hsize_t, 5> const& chunk,
                 TrajectoryStorage const& storage) {
  return std::endian::native == std::endian::little && storage.compression == 0 && chunk[0] == 1 &&
         chunk[2] == static_cast<hsize_t>(shape[1]) && chunk[3] == static_cast<hsize_t>(shape[0]);
}

}  // namespace

FramePieces frame_pieces(std::array<std::int64_t, 3> const& shape, std::size_t number_bytes,
                         TrajectoryStorage const& storage, std::int64_t most_planes,
                         std::int64_t cell_sites) {
  auto const chunk = chunk_of(block_of(shape, cell_sites), cell_sites, number_bytes, storage);
  auto const of_chunk = static_cast<std::int64_t>(chunk[1]);
  auto const plane_bytes = 3 * number_bytes * static_cast<std::size_t>(shape[0] * shape[1]);
  auto const of_chunk_bytes = 3 * number_bytes * chunk[0] * chunk[1] * chunk[2] * chunk[3];
  auto const copied = written_raw(shape, chunk, storage) ? 0 : 2 * of_chunk_bytes;
  if (cell_sites > 1)
    return {.planes = shape[2],
            .bytes = plane_bytes * static_cast<std::size_t>(shape[2]),
            .copied = copied + plane_bytes * chunk[1]};
  std::int64_t const most = most_planes > 0 ? std::min(most_planes, shape[2]) : shape[2];
  std::int64_t const chunks = most == shape[2] ? (most + of_chunk - 1) / of_chunk
                                               : std::max<std::int64_t>(1, most / of_chunk);
  return {.planes = std::min(chunks * of_chunk, shape[2]),
          .bytes = plane_bytes * static_cast<std::size_t>(chunks * of_chunk),
          .copied = copied};
}

FrameWriter::FrameWriter(hid_t file, TrajectoryHeader const& header,
                         TrajectoryStorage const& storage, std::filesystem::path path)
    : path_(std::move(path)),
      shape_(header.shape),
      cell_sites_(header.cell_sites),
      number_bytes_(header.precision == single_precision ? sizeof(float) : sizeof(double)),
      plane_bytes_(3 * number_bytes_ * static_cast<std::size_t>(shape_[0] * shape_[1])) {
  chunk_ = chunk_of(block_of(shape_, cell_sites_), cell_sites_, number_bytes_, storage);
  dataset_ = create_spins(file, header, storage, chunk_, path_);
  raw_ = written_raw(shape_, chunk_, storage);
  if (cell_sites_ > 1) part_.resize(plane_bytes_ * chunk_[1]);
}

std::uint64_t FrameWriter::frame_bytes() const {
  auto const in_chunks = [](std::int64_t extent, hsize_t of_chunk) {
    return (static_cast<hsize_t>(extent) + of_chunk - 1) / of_chunk * of_chunk;
  };
  return 3 * number_bytes_ * in_chunks(shape_[0], chunk_[3]) * in_chunks(shape_[1], chunk_[2]) *
         in_chunks(planes_of_site(), chunk_[1]) * static_cast<hsize_t>(cell_sites_) * chunk_[0];
}

void FrameWriter::begin(std::int64_t frame) {
  frame_ = frame;
  planes_ = 0;
  checksum_ = {};
}

void FrameWriter::require_planes(std::int64_t planes) const {
  auto const left = shape_[2] - planes_, of_chunk = static_cast<std::int64_t>(chunk_[1]);
  bool const in_pieces = cell_sites_ == 1 && planes > 0 && planes < left && planes % of_chunk == 0;
  if (planes == left || in_pieces) return;
  auto const accepted = cell_sites_ > 1 ? "all" : "whole chunks, of " + std::to_string(of_chunk);
  throw std::logic_error(path_.string() + ": " + std::to_string(planes) + " planes of " +
                         std::to_string(left) + " that are left; accepted: " + accepted);
}

void FrameWriter::add(std::int64_t planes, void const* spins) {
  require_planes(planes);
  auto const* const bytes = static_cast<std::byte const*>(spins);
  if (cell_sites_ > 1) return add_by_sites(bytes);
  write_part(0, planes_, planes, spins);
  checksum_.add({bytes, plane_bytes_ * static_cast<std::size_t>(planes)});
  planes_ += planes;
}

void FrameWriter::add_in_room(std::int64_t planes, std::byte* spins) {
  if (!raw_ || cell_sites_ > 1) return add(planes, spins);
  require_planes(planes);
  add_raw(planes, spins);
}

void FrameWriter::add_raw(std::int64_t planes, std::byte* spins) {
  if (planes_ == 0) grow(dataset_.get(), static_cast<hsize_t>(frame_) + 1, path_);
  auto const of_chunk = static_cast<std::int64_t>(chunk_[1]);
  for (std::int64_t begin = 0; begin < planes; begin += of_chunk) {
    auto const of_this = std::min(of_chunk, planes - begin);
    auto* const chunk = spins + plane_bytes_ * static_cast<std::size_t>(begin);
    checksum_.add({chunk, plane_bytes_ * static_cast<std::size_t>(of_this)});
    write_chunk(0, planes_ + begin, of_this, chunk);
  }
  planes_ += planes;
}

// Plane k * cell_sites + s holds site s of the cells with number k along z.
void FrameWriter::add_by_sites(std::byte const* spins) {
  if (raw_) grow(dataset_.get(), static_cast<hsize_t>(frame_) + 1, path_);
  auto const of_chunk = static_cast<std::int64_t>(chunk_[1]);
  sublattices_.clear();
  for (std::int64_t site = 0; site < cell_sites_; ++site) {
    SublatticeMean mean;
    for (std::int64_t first = 0; first < planes_of_site(); first += of_chunk) {
      auto const planes = std::min(of_chunk, planes_of_site() - first);
      for (std::int64_t k = 0; k < planes; ++k) {
        auto const from = static_cast<std::size_t>((first + k) * cell_sites_ + site);
        std::memcpy(part_.data() + plane_bytes_ * static_cast<std::size_t>(k),
                    spins + plane_bytes_ * from, plane_bytes_);
      }
      for (std::int64_t row = 0; row < planes * shape_[1]; ++row)
        if (number_bytes_ == sizeof(float))
          mean.add_row(reinterpret_cast<float const*>(part_.data()) + 3 * shape_[0] * row,
                       shape_[0]);
        else
          mean.add_row(reinterpret_cast<double const*>(part_.data()) + 3 * shape_[0] * row,
                       shape_[0]);
      checksum_.add({part_.data(), plane_bytes_ * static_cast<std::size_t>(planes)});
      raw_ ? write_chunk(site, first, planes, part_.data())
           : write_part(site, first, planes, part_.data());
    }
    sublattices_.push_back(mean.value());
  }
  planes_ = shape_[2];
}

void FrameWriter::write_part(std::int64_t site, std::int64_t first, std::int64_t planes,
                             void const* spins) {
  auto const nx = shape_[0], ny = shape_[1];
  append_block(
      dataset_.get(), number_bytes_ == sizeof(float) ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
      place(site, first),
      with_site(
          {1, static_cast<hsize_t>(planes), static_cast<hsize_t>(ny), static_cast<hsize_t>(nx), 3},
          cell_sites_, 1),
      spins, path_);
}

// Writes a chunk directly, because HDF5 would copy it. `chunk` must have room for all planes of a
// chunk; those after the first `planes` are set to 0.
void FrameWriter::write_chunk(std::int64_t site, std::int64_t first, std::int64_t planes,
                              std::byte* chunk) {
  auto const chunk_bytes = plane_bytes_ * chunk_[1];
  std::fill(chunk + plane_bytes_ * static_cast<std::size_t>(planes), chunk + chunk_bytes,
            std::byte{0});
  write_raw_chunk(dataset_.get(), place(site, first), chunk, chunk_bytes, path_);
}

Extents FrameWriter::place(std::int64_t site, std::int64_t plane) const {
  return with_site({static_cast<hsize_t>(frame_), static_cast<hsize_t>(plane), 0, 0, 0},
                   cell_sites_, static_cast<hsize_t>(site));
}

}  // namespace cayspin::inline v0_2::io
