// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <string>
#include <vector>

namespace cayspin::program {

/// Does standard output go to a terminal that shows colours and block characters?
bool terminal_shows_pictures();

/// The middle plane across the axis of fewest cells, of a crystal the first site of each cell, in
/// lines of coloured blocks with a key; a chain is one line. Colours are those of `cayspin plot`.
/// `spins`: (sites, 3).
std::string terminal_picture(io::Lattice const& lattice, std::vector<double> const& spins);

}  // namespace cayspin::program
