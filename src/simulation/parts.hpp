// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>
#include <cayspin/mpi/division.hpp>

#include <array>
#include <string>

namespace cayspin::inline v0_1::io {
struct Scene;
}

namespace cayspin::simulation {

struct Plan;

/// The rows and planes that a part needs of its neighbours: for the stages of a step, and as far as
/// couplings reach.
mpi::Depth depth_of_parts(io::Scene const& scene, Plan const& plan);

/// Numbers of parts along y and z, given as "y,z". Throws UsageError for what is none, and for
/// parts of fewer rows or planes than `depth`.
std::array<int, 2> read_parts(std::string const& text, cayspin::Lattice const& lattice,
                              mpi::Depth const& depth);

/// What a step repeats on such parts, of the work of a part: with `ghosts` stages, each goes as
/// many rows or planes further as stages follow it, at each end inside the lattice.
double repeated_share(cayspin::Lattice const& lattice, int ghosts, std::array<int, 2> const& parts);

}  // namespace cayspin::simulation
