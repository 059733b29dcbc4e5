// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/real_dataset.hpp"
#include "scalar_series.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace cayspin::io {

/// Dataset /spins of any HDF5 file, open for reading.
class StoredSpins {
 public:
  /// Throws unless it fits a lattice (nx, ny, nz), and, where it has frames, holds a whole one.
  StoredSpins(std::filesystem::path const& path, std::array<std::int64_t, 3> const& shape);

  /// The state or the last whole frame, packed as (nz, ny, nx, 3). Throws where a trajectory's
  /// frame is not as it was written.
  std::vector<double> last() const;

  /// Whole frame number `frame`. Throws also where there is none.
  std::vector<double> frame(std::int64_t frame) const;

 private:
  std::vector<double> checked(Extents const& begin) const;

  std::filesystem::path path_;
  RealDataset dataset_;
  std::optional<ScalarSeries> series_;  // of a trajectory file
  Extents begin_, frame_;
};

}  // namespace cayspin::io
