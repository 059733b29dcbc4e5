// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <vector>

namespace cayspin::program {

/// Returns true if standard output is a terminal that shows colours and block characters, unless
/// NO_COLOR is set.
bool terminal_shows_pictures();

/// Returns a picture of the middle plane normal to the axis with the fewest cells, as lines of
/// coloured blocks with a legend; a chain is one line. If cells have several sites, the picture
/// shows the first site of each. The colours are those of `cayspin plot`. `spins`: (sites, 3).
std::string terminal_picture(io::Lattice const& lattice, std::vector<double> const& spins);

}  // namespace cayspin::program
