// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/dataset.hpp"
#include "hdf5/handle.hpp"
#include "io/trajectory.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// The datasets of one group: time, step, energy, norm_defect, magnetization and checksum. Frames
/// of crystals with several sites per cell also have sublattice_magnetization. The datasets of
/// MoreScalars come last. Files of earlier versions have no checksums.
class ScalarSeries {
 public:
  /// `cell_sites`: of the lattice for frames; 1 for samples that are not frames.
  static ScalarSeries create(hid_t group, std::filesystem::path const& path,
                             std::int64_t cell_sites = 1, MoreScalars const& more = {});
  static ScalarSeries open(hid_t group, std::filesystem::path const& path,
                           std::int64_t cell_sites = 1);

  /// `spins`: the checksum of a frame's spins, or 1 for samples without spins. `more`: the further
  /// numbers of each sample, sample after sample.
  void append(std::vector<Sample> const& samples, std::filesystem::path const& path,
              std::uint32_t spins = 1, std::vector<double> const& more = {});

  /// Returns the number of complete samples, which is the length of the shortest dataset.
  std::int64_t size(std::filesystem::path const& path) const;
  /// Returns the number of samples that can be read. A process that was killed while it added
  /// samples may have left up to `most_torn` damaged ones at the end.
  std::int64_t readable(std::int64_t most_torn, std::filesystem::path const& path) const;
  /// Returns samples `begin` to `end` - 1. Throws std::runtime_error if one is damaged.
  std::vector<Sample> read(std::int64_t begin, std::int64_t end,
                           std::filesystem::path const& path) const;

  /// Returns the further numbers of samples `begin` to `end` - 1, sample after sample.
  std::vector<double> read_more(std::int64_t begin, std::int64_t end,
                                std::filesystem::path const& path) const;
  /// Returns the count of further numbers per sample.
  std::size_t more_count() const;
  MoreScalars more_scalars(std::filesystem::path const& path) const;

  bool has_checksums() const { return checksum_.get() >= 0; }
  /// Returns the checksum of the spins of a frame; requires has_checksums().
  std::uint32_t spins_checksum(std::int64_t frame, std::filesystem::path const& path) const;

 private:
  bool is_readable(std::int64_t sample, std::filesystem::path const& path) const;
  std::vector<std::uint64_t> read_checksums(std::int64_t begin, std::int64_t end,
                                            std::filesystem::path const& path) const;

  struct MoreColumn {
    char const* name;
    Extents of_sample;  // extents after the first, which counts samples
    DatasetHandle dataset;
  };

  std::vector<DatasetHandle> columns_;  // with one or three numbers per sample
  std::vector<MoreColumn> more_;
  DatasetHandle checksum_;
  hsize_t size_ = 0;
};

}  // namespace cayspin::inline v0_2::io
