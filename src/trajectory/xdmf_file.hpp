// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>

namespace cayspin::inline v0_2::io {

/// The lattice that an XDMF file describes.
struct XdmfGrid {
  std::array<std::int64_t, 3> shape;  ///< as in TrajectoryHeader
  std::int64_t cell_sites = 1;
  std::array<double, 3> spacing = {1, 1, 1};
  bool has_positions = false;  ///< the trajectory file has /positions, which replace the spacing
};

/// Describes /spins of a trajectory file to viewers such as ParaView: an XDMF time series of a
/// vector field on a regular grid, or at the points of /positions. The XDMF file is replaced as a
/// whole, so that it is valid at every moment.
class XdmfFile {
 public:
  /// Creates the file, without frames. An existing file is an error unless `overwrite`.
  XdmfFile(std::filesystem::path path, std::filesystem::path const& trajectory,
           XdmfGrid const& grid, bool single, bool overwrite);

  /// Adds the next frame. Beyond a thousand frames, the file is written at most once a second.
  void add_frame(double time);

  /// Writes the frames that add_frame has postponed.
  void finish();

 private:
  void write(bool overwrite);

  using Clock = std::chrono::steady_clock;
  std::filesystem::path path_;
  std::string grid_, extents_, spins_, frames_;
  std::int64_t count_ = 0, written_ = 0;
  Clock::time_point last_write_;
};

}  // namespace cayspin::inline v0_2::io
