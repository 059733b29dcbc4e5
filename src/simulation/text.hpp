// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/units.hpp"

#include <array>
#include <cstdint>
#include <string>
#include <string_view>

namespace cayspin::simulation {

/// "1.2 GB"
std::string bytes_text(double bytes);
std::string bytes_text(std::int64_t bytes);
/// "3 min 20 s"
std::string duration_text(double seconds);
/// "1 step", "2 steps"
std::string counted(std::int64_t count, std::string_view what);
/// The cells of a lattice as TrajectoryHeader has it: "4 x 3 x 2", or "4 x 3 x 2 cells of 3 sites".
std::string cells_text(std::array<std::int64_t, 3> const& shape, std::int64_t cell_sites);
/// The same, or "4 x 3 x 2 sites".
std::string sites_text(std::array<std::int64_t, 3> const& shape, std::int64_t cell_sites);
/// With a decimal prefix: "12.3 M" for 12300000.
std::string rate_text(double per_second);
/// A time or an energy as the scene has them: a number, in SI with its unit.
std::string time_text(io::Units const& units, double time, int digits = 9);
std::string energy_text(io::Units const& units, double energy, int digits = 9);
/// As one word of a command line: quoted where a shell would read it otherwise.
std::string shell_word(std::string const& text);
/// Without line breaks and control characters.
std::string one_line(std::string text);

}  // namespace cayspin::simulation
