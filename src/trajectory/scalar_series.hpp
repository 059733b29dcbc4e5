// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/handle.hpp"
#include "io/trajectory.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::inline v0_1::io {

using Vector = std::array<double, 3>;

/// The datasets time, step, energy, norm_defect, magnetization and checksum of one group, and
/// sublattice_magnetization of the frames of crystals with several sites in a cell. Files of
/// earlier versions have no checksums.
class ScalarSeries {
 public:
  /// `cell_sites`: of frames; 1 for samples without them.
  static ScalarSeries create(hid_t group, std::filesystem::path const& path,
                             std::int64_t cell_sites = 1);
  static ScalarSeries open(hid_t group, std::filesystem::path const& path,
                           std::int64_t cell_sites = 1);

  /// `spins`: the checksum of a frame's spins, and 1 for samples without. `sublattices` of one
  /// frame, where they are stored.
  void append(std::vector<Sample> const& samples, std::filesystem::path const& path,
              std::uint32_t spins = 1, std::vector<Vector> const& sublattices = {});

  /// Samples that are whole: the shortest of the datasets counts.
  std::int64_t size(std::filesystem::path const& path) const;
  /// Of these samples, those that can be read. A killed process may have left up to `most_torn`
  /// that cannot: what it was adding at that moment.
  std::int64_t readable(std::int64_t most_torn, std::filesystem::path const& path) const;
  /// Of these samples, those from `begin` to `end`. Throws where one is not as it was written.
  std::vector<Sample> read(std::int64_t begin, std::int64_t end,
                           std::filesystem::path const& path) const;

  /// Of each sample, one after the other; empty where none are stored.
  std::vector<Vector> read_sublattices(std::int64_t begin, std::int64_t end,
                                       std::filesystem::path const& path) const;

  bool has_checksums() const { return checksum_.get() >= 0; }
  /// The checksum of the spins of a frame, which has_checksums() has.
  std::uint32_t spins_checksum(std::int64_t frame, std::filesystem::path const& path) const;

 private:
  bool is_readable(std::int64_t sample, std::filesystem::path const& path) const;
  std::vector<std::uint64_t> read_checksums(std::int64_t begin, std::int64_t end,
                                            std::filesystem::path const& path) const;

  std::vector<DatasetHandle> columns_;  // with one number, or three, of each sample
  DatasetHandle checksum_, sublattices_;
  std::int64_t cell_sites_ = 1;
  hsize_t size_ = 0;
};

}  // namespace cayspin::inline v0_1::io
