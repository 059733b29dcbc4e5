// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/modes.hpp"
#include "io/path.hpp"

#include <filesystem>
#include <string>

namespace cayspin::program {

/// Returns the unit of the prefactor in one direction of a path with rates, with a leading space;
/// empty in reduced units. The rate is prefactor * T^(n / 2) * exp(-barrier / kT), where the
/// initial state has n more zero modes than the saddle.
std::string unit_of_prefactor(io::Path const& path, bool forward);

/// Summarise the file of a path, or of modes or waves.
void print_path(std::filesystem::path const& file, io::Path const& path);
void print_modes(std::filesystem::path const& file, io::BandsContents const& found);

}  // namespace cayspin::program
