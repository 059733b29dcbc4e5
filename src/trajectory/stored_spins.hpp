// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/real_dataset.hpp"
#include "io/site_box.hpp"
#include "io/trajectory.hpp"
#include "scalar_series.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Dataset /spins of any HDF5 file, open for reading.
class StoredSpins {
 public:
  /// Throws unless the dataset fits a lattice (nx, ny, nz) with `cell_sites` sites per cell and, if
  /// it has frames, at least one of them is whole.
  StoredSpins(std::filesystem::path const& path, std::array<std::int64_t, 3> const& shape,
              std::int64_t cell_sites = any_cell_sites);

  /// Returns the last whole frame, or the state of a file without frames, packed as (nz, ny, nx,
  /// 3); or a box of it. Throws if a frame of a trajectory is damaged. Spins that are stored site
  /// by site are returned in the order of TrajectoryHeader::shape.
  std::vector<double> last() const;
  std::vector<double> last(SiteBox const& box) const;

  /// Returns frame number `frame`. Throws also if no whole frame has this number.
  std::vector<double> frame(std::int64_t frame) const;

 private:
  SiteBox all() const { return {{0, 0, 0}, shape_}; }
  [[noreturn]] void refuse_extents(std::int64_t cell_sites) const;
  template <class Read>
  std::vector<double> by_planes(SiteBox const& box, Read const& read) const;
  std::vector<double> checked(Extents const& begin, SiteBox const& box) const;

  std::filesystem::path path_;
  std::array<std::int64_t, 3> shape_;
  RealDataset dataset_;
  std::optional<ScalarSeries> series_;  // set for a trajectory file
  std::int64_t sites_ = 1;              // per cell, if /spins has an extent for them
  bool framed_ = false;
  Extents begin_, frame_;
};

}  // namespace cayspin::inline v0_2::io
