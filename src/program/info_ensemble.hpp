// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble_file.hpp"

#include <filesystem>

namespace cayspin::program {

/// Summarises the file of an ensemble.
void print_ensemble(std::filesystem::path const& file, io::EnsembleInfo const& info);

}  // namespace cayspin::program
