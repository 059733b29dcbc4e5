// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

namespace cayspin::inline v0_1::io {

/// A trajectory file that another process may be writing.
///
/// Beside a writer it takes no lock and writes nothing, so that one does not notice. A file that a
/// kill or a power cut left with a journal is completed, as by complete_file(). What a look finds
/// half written is not believed: a sample counts when an earlier look found it in the file already.
class FollowedTrajectory {
 public:
  using Clock = std::chrono::system_clock;

  explicit FollowedTrajectory(std::filesystem::path path) : path_(std::move(path)) {}

  /// Reads what is new. A file that another one has replaced is read from its begin. Throws
  /// std::runtime_error, one line, when the file cannot be read; while a process is writing it, a
  /// later look may succeed.
  void look();

  std::filesystem::path const& path() const { return path_; }
  TrajectoryHeader const& header() const { return header_; }
  bool complete() const { return complete_; }
  /// Of a run that has ended, otherwise 0.
  RunCost const& cost() const { return cost_; }

  /// The samples of /scalars, or the scalars of the frames where there are more of these.
  std::vector<std::int64_t> const& steps() const { return longer().steps; }
  std::vector<double> const& times() const { return longer().times; }
  std::vector<Scalars> const& scalars() const { return longer().scalars; }

  /// When the file was last written, and created where the file system knows.
  Clock::time_point written() const { return written_; }
  std::optional<Clock::time_point> created() const { return created_; }

 private:
  struct Series {
    std::int64_t seen = 0;  // in the file at the last look
    std::vector<std::int64_t> steps;
    std::vector<double> times;
    std::vector<Scalars> scalars;
  };

  Series const& longer() const {
    return frames_.steps.size() > samples_.steps.size() ? frames_ : samples_;
  }
  void read_file();
  void read_times_of_file();
  void read_series(std::int64_t group, std::int64_t cell_sites, Series& series, bool all) const;

  std::filesystem::path path_;
  std::uint64_t identity_ = 0;
  TrajectoryHeader header_;
  RunCost cost_;
  bool complete_ = false;
  Series samples_, frames_;
  Clock::time_point written_{};
  std::optional<Clock::time_point> created_;
};

/// Does a process have the file open for writing? Unknown where files are not locked.
std::optional<bool> is_being_written(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_1::io
