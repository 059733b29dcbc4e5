// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/real_dataset.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace cayspin::io {

/// Dataset /spins of any HDF5 file, open for reading.
class StoredSpins {
 public:
  /// Throws unless it fits a lattice (nx, ny, nz), and, where it has frames, holds a whole one.
  StoredSpins(std::filesystem::path const& path, std::array<std::int64_t, 3> const& shape);

  /// The state or the last whole frame, packed as (nz, ny, nx, 3).
  std::vector<double> last() const;

  /// Whole frame number `frame`. Throws where there is none.
  std::vector<double> frame(std::int64_t frame) const;

 private:
  RealDataset dataset_;
  Extents begin_, frame_;
};

}  // namespace cayspin::io
