// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>

#include <array>
#include <string>

namespace cayspin::simulation {

/// Numbers of parts along y and z, given as "y,z". Throws UsageError for what is none, and for
/// parts of fewer rows or planes than `ghosts`.
std::array<int, 2> read_parts(std::string const& text, cayspin::Lattice const& lattice, int ghosts);

/// What a step repeats on such parts, of the work of a part: with `ghosts` stages, each goes as
/// many rows or planes further as stages follow it, at each end inside the lattice.
double repeated_share(cayspin::Lattice const& lattice, int ghosts, std::array<int, 2> const& parts);

}  // namespace cayspin::simulation
