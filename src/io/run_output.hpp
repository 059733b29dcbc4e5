// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Options for the files of a run: the trajectory and the files beside it.
struct RunOutputOptions {
  bool overwrite = false;
  TrajectoryStorage storage = {};
  std::int64_t most_planes = 0;  ///< most planes of a piece, as in frame_pieces(); 0: all
  bool xdmf = false;             ///< FILE.xdmf, which describes FILE.h5 to viewers
  bool table = false;            ///< FILE.txt, a line for each sample
  std::array<double, 3> spacing = {1, 1, 1};  ///< of the lattice, for the XDMF file
  /// x, y and z of a crystal's sites in the order of the file; empty: a regular grid.
  std::vector<double> positions = {};
};

/// Writes a run's files in a separate thread, and buffers up to two frames or pieces of frames. If
/// writing fails, a later call throws the error, with a message like those of TrajectoryFile. All
/// calls must come from one thread, which must not use HDF5 until finish(), close() or the
/// destructor.
class RunOutput {
 public:
  /// Creates the files. Without `overwrite`, it is an error if one of them exists, and none is
  /// changed. Throws std::invalid_argument for a wrong header or wrong options.
  RunOutput(std::filesystem::path path, TrajectoryHeader const& header,
            RunOutputOptions const& options);

  /// Writes the buffered data. Unless finish() was called, the trajectory stays marked as
  /// incomplete.
  ~RunOutput();
  RunOutput(RunOutput&&) noexcept;
  RunOutput& operator=(RunOutput&&) noexcept;

  /// Returns memory for the next frame or its next piece, packed as (planes, ny, nx, 3) in the
  /// precision of the header; the other precision throws std::logic_error. Waits while both buffers
  /// are full.
  template <class Real>
  Real* frame();

  /// Queues a piece that is not the frame's last.
  void write_piece();

  /// Queues the frame, or its last piece.
  void write_frame(std::int64_t step, double time, Scalars const& scalars,
                   FrameNumbers const& numbers = {});

  /// Queues a sample. It reaches the files with the next frame or, if more samples follow, within
  /// about a second.
  void write_scalars(std::int64_t step, double time, Scalars const& scalars,
                     std::vector<double> const& more = {});

  /// Write everything that is queued, then act like TrajectoryFile's functions of these names.
  void finish(RunCost const& cost);
  void close(RunCost const& cost);

  std::int64_t frames();  ///< frames in the file; waits for queued ones
  std::filesystem::path const& path() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace cayspin::inline v0_2::io
