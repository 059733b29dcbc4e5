// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {

/// Returns headings and lines on an incomplete run: whether it is still running, its progress, and
/// the time left. `being_written`: the result of io::is_being_written for its file, obtained before
/// `info` was read.
std::vector<std::pair<std::string, std::string>> progress_lines(io::TrajectoryInfo const& info,
                                                                std::optional<bool> being_written);

}  // namespace cayspin::program
