// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::program {

/// Headings and lines on a run that is not complete: whether it is still running, how far it is,
/// and for how long it goes on. `being_written`: as io::is_being_written says of its file, asked
/// before `info` was read.
std::vector<std::pair<std::string, std::string>> progress_lines(io::TrajectoryInfo const& info,
                                                                std::optional<bool> being_written);

}  // namespace cayspin::program
