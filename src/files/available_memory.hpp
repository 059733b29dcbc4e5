// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>
#include <filesystem>

namespace cayspin::inline v0_1::io {

/// Bytes that this process may still take: what the machine has, and at most what its control
/// groups (version 1 or 2) leave, those of a batch job or a container. The largest number where
/// nothing is known. `root` stands before /proc and /sys.
std::int64_t available_memory(std::filesystem::path const& root = "/");

}  // namespace cayspin::inline v0_1::io
