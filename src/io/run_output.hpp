// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace cayspin::inline v0_1::io {

/// What a run writes besides its trajectory.
struct RunOutputOptions {
  bool overwrite = false;
  TrajectoryStorage storage = {};
  std::int64_t most_planes = 0;               ///< of a frame in memory, as frame_pieces() has it
  bool xdmf = false;                          ///< FILE.xdmf, which describes FILE.h5 to viewers
  bool table = false;                         ///< FILE.txt, a line for each sample
  std::array<double, 3> spacing = {1, 1, 1};  ///< of the lattice, for the XDMF file
  /// Of the sites of a crystal, x, y and z in the order of the file; empty: on a regular grid.
  std::vector<double> positions = {};
};

/// Writes the files of a run while the run goes on: a thread of its own takes up to two frames, or
/// pieces of frames, from it. What fails there is thrown by the next call, as TrajectoryFile throws
/// it. To be called from one thread, which until finish(), close() or the destructor leaves HDF5 to
/// this object.
class RunOutput {
 public:
  /// Creates the files. One that exists is an error unless `overwrite`, and then none is changed.
  RunOutput(std::filesystem::path path, TrajectoryHeader const& header,
            RunOutputOptions const& options);

  /// Writes what was handed over. Without finish() before, the trajectory is not complete.
  ~RunOutput();
  RunOutput(RunOutput&&) noexcept;
  RunOutput& operator=(RunOutput&&) noexcept;

  /// Room for the next frame, or for its next piece, packed as (planes, ny, nx, 3) in the precision
  /// of the header; the other one throws std::logic_error. Waits while two are under way.
  template <class Real>
  Real* frame();

  /// Hands over a piece that is not the frame's last.
  void write_piece();

  /// Hands over the frame, or its last piece.
  void write_frame(std::int64_t step, double time, Scalars const& scalars);

  /// Samples reach the files with the next frame, or after about a second of calls.
  void write_scalars(std::int64_t step, double time, Scalars const& scalars);

  /// End the run as those of TrajectoryFile do, after all else is written.
  void finish(RunCost const& cost);
  void close(RunCost const& cost);

  std::int64_t frames();  ///< frames in the file; waits for those under way
  std::filesystem::path const& path() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace cayspin::inline v0_1::io
