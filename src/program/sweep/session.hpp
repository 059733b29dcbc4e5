// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "grid.hpp"
#include "io/sweep.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::program::sweep {

/// The file of a sweep, and the folder next to it where its runs write their files, locked against
/// other processes.
class Session {
 public:
  /// Continues the sweep in the file. If the file does not exist, or with `overwrite`, starts a new
  /// sweep. Throws UsageError if the file has other contents (without `overwrite`), if its folder
  /// does not exist, if the file cannot be written, and if another process is writing it.
  Session(std::filesystem::path file, Grid const& grid, bool overwrite);
  ~Session();
  Session(Session const&) = delete;
  Session& operator=(Session const&) = delete;

  io::SweepInfo const& info() const { return info_; }
  io::SweptRun const& run(std::int64_t number) const { return info_.runs[index(number)]; }
  std::filesystem::path run_file(std::int64_t number) const;

  /// Returns the runs that are still to do.
  std::vector<std::int64_t> open_runs() const;

  /// Records the end of a run. If `status` is done, but the run's file does not hold a complete run
  /// of the planned scene, the recorded status is wrong_usage.
  void take(std::int64_t number, std::int64_t status, std::string const& message);

  /// Writes the recorded results.
  void write();
  /// Writes the results. If all runs have ended, copies their files into the sweep's file, and
  /// removes these files, their checkpoints, and the folder if nothing else is in it. Returns false
  /// if interrupted.
  bool close();

 private:
  static std::size_t index(std::int64_t number) { return static_cast<std::size_t>(number); }
  void open(bool is_new);
  void release();
  bool read_run(std::int64_t number, io::SweptRun& run) const;
  bool is_finished() const;
  void require_same_sweep() const;
  void require_replaceable() const;
  void require_no_runs() const;
  void lock_folder();
  void remove_folder();

  std::filesystem::path file_, folder_;
  Grid const& grid_;
  io::SweepInfo info_;
  io::SweepCopies copies_;
  int lock_ = -1;
  std::chrono::steady_clock::time_point written_;
};

}  // namespace cayspin::program::sweep
