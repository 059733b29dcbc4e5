// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/modes.hpp"
#include "io/path.hpp"

#include <filesystem>

namespace cayspin::program {

/// Summarise the file of a path, or of modes or waves.
void print_path(std::filesystem::path const& file, io::Path const& path);
void print_modes(std::filesystem::path const& file, io::BandsContents const& found);

}  // namespace cayspin::program
