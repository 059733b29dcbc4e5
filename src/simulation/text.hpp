// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/counted.hpp"
#include "io/key.hpp"
#include "io/units.hpp"

#include <array>
#include <cstdint>
#include <string>

namespace cayspin::simulation {

using io::counted;

/// Returns "1.2 GB", for example.
std::string bytes_text(double bytes);
std::string bytes_text(std::int64_t bytes);
/// Returns "3 min 20 s", for example.
std::string duration_text(double seconds);
/// Returns the cells of a lattice in the form of TrajectoryHeader: "4 x 3 x 2", or "4 x 3 x 2 cells
/// of 3 sites".
std::string cells_text(std::array<std::int64_t, 3> const& shape, std::int64_t cell_sites);
/// Returns cells_text, but "4 x 3 x 2 sites" if there is one site per cell.
std::string sites_text(std::array<std::int64_t, 3> const& shape, std::int64_t cell_sites);
/// Returns a number with a decimal prefix: "12.3 M" for 12300000.
std::string rate_text(double per_second);
/// Returns a time or an energy, given in reduced units, in the units of the scene. In SI the text
/// ends with the unit.
std::string time_text(io::Units const& units, double time, int digits = 9);
std::string energy_text(io::Units const& units, double energy, int digits = 9);
/// Returns a factor that is a number or an expression in t. In SI, expressions have been converted
/// to a t in reduced units, which the text says.
std::string factor_text(io::Units const& units, io::AppliedComponent const& factor);
/// Returns one word of a command line, quoted if a shell would change it.
std::string shell_word(std::string const& text);
/// Returns the text without line breaks at its end, and with spaces in place of other control
/// characters.
std::string one_line(std::string text);

}  // namespace cayspin::simulation
