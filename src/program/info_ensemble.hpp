// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble_file.hpp"

#include <filesystem>

namespace cayspin::program {

/// Summarises the file of an ensemble. `is_running`: a process is writing it.
void print_ensemble(std::filesystem::path const& file, io::EnsembleInfo const& info,
                    bool is_running);

}  // namespace cayspin::program
