// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <filesystem>

namespace cayspin::program {

/// Summarise the file of a path, or of modes or waves. Return the exit status.
int print_path(std::filesystem::path const& file);
int print_modes(std::filesystem::path const& file);

}  // namespace cayspin::program
