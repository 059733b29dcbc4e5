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

struct Plan;

/// Returns how many rows and planes a part needs from its neighbours: for the stages of a step, and
/// for the range of couplings.
mpi::Depth depth_of_parts(io::Scene const& scene, Plan const& plan);

/// Reads numbers of parts along y and z, given as "y,z". Throws UsageError for invalid text, and
/// for parts of fewer rows or planes than `depth`.
std::array<int, 2> read_parts(std::string const& text, cayspin::Lattice const& lattice,
                              mpi::Depth const& depth);

/// Returns the work that a step repeats on such parts, relative to the work of a part: with
/// `ghosts` stages, each works on one more row or plane per later stage, at each end inside the
/// lattice.
double repeated_share(cayspin::Lattice const& lattice, int ghosts, std::array<int, 2> const& parts);

}  // namespace cayspin::simulation
