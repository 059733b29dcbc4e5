// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble.hpp"
#include "io/run_output.hpp"
#include "io/trajectory.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Result of the search for the equilibrium of one replica, by `cayspin relax`.
struct RelaxedReplica {
  double torque = 0;  ///< max |m x H|, reduced; in SI, max |m x mu0 H| in T
  bool converged = false;
  std::int64_t evaluations = 0;
};

/// The trajectory file of an ensemble (HDF5; docs/reference/file_format.md has the layout). Errors
/// are those of TrajectoryFile.
class EnsembleFile {
 public:
  /// `header`: that of one replica. The only options used are `overwrite`, `positions`,
  /// `storage.compression` and `storage.frames`.
  EnsembleFile(std::filesystem::path path, TrajectoryHeader const& header, Ensemble const& ensemble,
               RunOutputOptions const& options);
  ~EnsembleFile();
  EnsembleFile(EnsembleFile&&) noexcept;

  /// Appends a frame: the spins of all replicas, packed as (replica, nz, ny, nx, 3) in the
  /// precision of the header, and the scalars of each replica. Then flushes.
  void write_frame(std::int64_t step, double time, std::vector<Scalars> const& scalars,
                   std::vector<std::byte> const& spins);
  /// Appends a sample to /scalars, and flushes if the last flush was a second ago. Otherwise the
  /// sample reaches the file with a later one, or with the next frame.
  void write_scalars(std::int64_t step, double time, std::vector<Scalars> const& scalars);

  void write_relaxed(std::vector<RelaxedReplica> const& replicas);

  /// Ends the file of a run that went as planned: sets `complete` = 1.
  void finish(RunCost const& cost);
  /// Ends the file of a run that was interrupted or failed: like finish(), but `complete` stays 0.
  void close(RunCost const& cost);

  std::int64_t frames() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Contents of an ensemble file except its spins.
struct EnsembleInfo {
  TrajectoryHeader header;  ///< of one replica
  Ensemble ensemble;
  RunCost cost;
  bool complete = false;
  std::int64_t frames = 0, samples = 0;  ///< numbers of whole frames and samples
  std::int64_t step = 0;                 ///< of the last frame
  double time = 0;                       ///< of the last frame
  std::vector<Scalars> last;             ///< of each replica, in the last frame
  /// For crystals with several sites per cell, cell_sites entries for each replica in the last
  /// frame, as TrajectoryInfo::frame_sublattices. Empty for files of earlier versions.
  std::vector<std::array<double, 3>> last_sublattices;
  std::vector<RelaxedReplica> relaxed;  ///< each replica's search; empty for a run
};

/// Consecutive replicas of an ensemble.
struct ReplicaRange {
  std::int64_t first = 0, count = 0;
};

bool is_ensemble(std::filesystem::path const& path);
/// Throws std::runtime_error with one line.
EnsembleInfo read_ensemble_info(std::filesystem::path const& path);
/// Reads a file that another process is writing, as read_info_while_written() does. Returns nothing
/// if it is not the file of an ensemble.
std::optional<EnsembleInfo> read_ensemble_info_while_written(std::filesystem::path const& path);
/// Reads the spins of these replicas in the last frame, one replica after the other, each packed as
/// (nz, ny, nx, 3) in the order of TrajectoryHeader::shape. Numbers are not rounded. Throws
/// std::runtime_error with one line, also for a replica whose checksum differs.
std::vector<double> read_ensemble_spins(std::filesystem::path const& path, EnsembleInfo const& info,
                                        ReplicaRange const& replicas);

}  // namespace cayspin::inline v0_2::io
