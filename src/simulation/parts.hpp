// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>
#include <cayspin/mpi/division.hpp>

#include <array>
#include <string>

namespace cayspin::inline v0_2::io {
struct Scene;
}

namespace cayspin::simulation {

/// Returns how many rows and planes a part needs from its neighbours: `ghosts` for the stages of a
/// step, or more if couplings or interlayers reach further.
mpi::Depth depth_of_parts(io::Scene const& scene, cayspin::Lattice const& lattice, int ghosts);

/// Reads the numbers of parts along y and z from text such as "1,4". Throws UsageError for invalid
/// text, and for parts of fewer rows or planes than `depth`.
std::array<int, 2> read_parts(std::string const& text, cayspin::Lattice const& lattice,
                              mpi::Depth const& depth);

/// Returns how much work a step repeats because the parts overlap, relative to the work of a part.
/// A step has `ghosts` stages. At each end of a part that is inside the lattice, a stage works on
/// one additional row or plane for each later stage.
double repeated_share(cayspin::Lattice const& lattice, int ghosts, std::array<int, 2> const& parts);

}  // namespace cayspin::simulation
