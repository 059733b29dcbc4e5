// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/modes.hpp"
#include "io/path.hpp"

#include <filesystem>
#include <string>

namespace cayspin::program {

/// Returns the unit of the rate prefactor in one direction of a path, with a leading space, or an
/// empty string in reduced units. In SI, `path` must have rates. The rate is
///   prefactor * T^(n / 2) * exp(-barrier / kT),
/// where the state that is left in this direction has n more zero modes than the saddle.
std::string unit_of_prefactor(io::Path const& path, bool forward);

/// Returns a line that says how many curvatures are negative beyond their errors; empty if none is.
std::string saddle_text(io::ModesContents const& found);

/// Print a summary of a file of a path, or of a file of modes or spin waves.
void print_path(std::filesystem::path const& file, io::Path const& path);
void print_modes(std::filesystem::path const& file, io::BandsContents const& found);

}  // namespace cayspin::program
