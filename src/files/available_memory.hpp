// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>
#include <filesystem>

namespace cayspin::inline v0_2::io {

/// Returns how many more bytes this process may allocate: the machine's available memory, limited
/// by the control groups (version 1 or 2) of a batch job or a container. Returns the largest
/// std::int64_t if nothing is known. `root` is prepended to the paths in /proc and /sys.
std::int64_t available_memory(std::filesystem::path const& root = "/");

}  // namespace cayspin::inline v0_2::io
