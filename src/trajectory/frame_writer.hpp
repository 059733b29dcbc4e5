// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "fletcher32.hpp"
#include "hdf5/dataset.hpp"
#include "io/trajectory.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Dataset /spins of a trajectory file, to which frames are added by planes along z. Frames of a
/// crystal with several sites per cell are added as a whole, and stored site by site.
class FrameWriter {
 public:
  FrameWriter() = default;
  /// Creates the dataset.
  FrameWriter(hid_t file, TrajectoryHeader const& header, TrajectoryStorage const& storage,
              std::filesystem::path path);

  /// Returns the bytes that a frame may take in the file: the first frame of a chunk takes the
  /// space of the whole chunk.
  std::uint64_t frame_bytes() const;

  /// Starts frame number `frame`. If it was started before, all its planes must be added again.
  void begin(std::int64_t frame);
  /// Adds the next planes: those of whole chunks, or all that are left. Other numbers throw
  /// std::logic_error.
  void add(std::int64_t planes, void const* spins);
  /// Adds planes without a copy if possible. `spins` must have room for a whole piece; the room
  /// behind the planes may be overwritten.
  void add_in_room(std::int64_t planes, std::byte* spins);

  std::int64_t planes() const { return planes_; }  ///< added to the frame so far
  bool is_whole() const { return planes_ == shape_[2]; }
  Fletcher32 const& checksum() const { return checksum_; }
  /// Returns the last frame's entries of TrajectoryInfo::frame_sublattices; empty if cells have one
  /// site.
  std::vector<std::array<double, 3>> const& sublattices() const { return sublattices_; }

  void close() { dataset_.close(); }

 private:
  void require_planes(std::int64_t planes) const;
  void add_raw(std::int64_t planes, std::byte* spins);
  void add_by_sites(std::byte const* spins);
  void write_part(std::int64_t site, std::int64_t first, std::int64_t planes, void const* spins);
  void write_chunk(std::int64_t site, std::int64_t first, std::int64_t planes, std::byte* chunk);
  std::int64_t planes_of_site() const { return shape_[2] / cell_sites_; }
  Extents place(std::int64_t site, std::int64_t plane) const;

  std::filesystem::path path_;
  DatasetHandle dataset_;
  std::array<std::int64_t, 3> shape_{};
  std::int64_t cell_sites_ = 1;
  std::array<hsize_t, 5> chunk_{};
  std::size_t number_bytes_ = 0, plane_bytes_ = 0;
  bool raw_ = false;
  std::int64_t frame_ = 0, planes_ = 0;
  Fletcher32 checksum_;
  std::vector<std::byte> part_;  // planes of a chunk, all of one site of the cells
  std::vector<std::array<double, 3>> sublattices_;
};

}  // namespace cayspin::inline v0_2::io
