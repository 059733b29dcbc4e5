// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <filesystem>

namespace cayspin::program {

/// `cayspin info` of the file of an ensemble. Returns the exit status.
int print_ensemble(std::filesystem::path const& file);

}  // namespace cayspin::program
