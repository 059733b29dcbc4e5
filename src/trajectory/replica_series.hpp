// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/dataset.hpp"
#include "hdf5/handle.hpp"
#include "io/trajectory.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Returns properties of a dataset in which numbers that never reached the disk are read as
/// `missing`.
PropertyHandle filled_with(double missing, std::filesystem::path const& path);

/// The numbers of a frame of an ensemble that are not in Scalars.
struct ReplicaFrame {
  std::vector<double> sublattices;       ///< (replica, site, 3); empty if cells have one site
  std::vector<std::uint64_t> checksums;  ///< (replica), as in trajectory files
};

/// The datasets time, step, energy, norm_defect and magnetization of one group. The first two have
/// one entry per sample, the others one per sample and replica. For frames, there are also checksum
/// and, for crystals with several sites per cell, sublattice_magnetization.
class ReplicaSeries {
 public:
  static ReplicaSeries create(hid_t group, std::int64_t replicas,
                              std::filesystem::path const& path);
  static ReplicaSeries create_of_frames(hid_t group, std::int64_t replicas, std::int64_t cell_sites,
                                        std::filesystem::path const& path);

  void append(std::int64_t step, double time, std::vector<Scalars> const& scalars,
              std::filesystem::path const& path);
  void append(std::int64_t step, double time, std::vector<Scalars> const& scalars,
              ReplicaFrame const& frame, std::filesystem::path const& path);

 private:
  DatasetHandle time_, step_, energy_, norm_defect_, magnetization_;
  DatasetHandle sublattices_, checksum_;
  hsize_t replicas_ = 0, cell_sites_ = 1, size_ = 0;
};

}  // namespace cayspin::inline v0_2::io
