// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {

/// Progress of an incomplete run.
struct RunProgress {
  std::optional<bool> is_running = {};     ///< nothing if it cannot be found out
  double idle = 0;                         ///< seconds since the file was last written
  std::optional<io::Sample> last = {};     ///< the last frame or sample
  std::optional<std::int64_t> steps = {};  ///< planned
  std::optional<double> seconds = {};      ///< so far; nothing if the file has the run's cost
  std::optional<double> updates_per_second = {};  ///< spin updates
  std::optional<double> seconds_left = {};
};

/// `being_written`: the result of io::is_being_written for the file, obtained before `info` was
/// read.
RunProgress progress_of(io::TrajectoryInfo const& info, std::optional<bool> being_written);

/// Returns the progress as lines, each with its heading.
std::vector<std::pair<std::string, std::string>> progress_lines(io::TrajectoryInfo const& info,
                                                                std::optional<bool> being_written);

}  // namespace cayspin::program
