// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <filesystem>
#include <vector>

namespace cayspin::inline v0_2::io::detail {

/// Throws std::runtime_error unless an HDF5 or OVF file has spins for a lattice. Checks only types
/// and shapes.
void check_start_file(std::filesystem::path const& path, Lattice const& lattice);

/// Returns the spins of a box as stored in the file, in the order of initial_spins. Reads an OVF
/// file completely.
std::vector<double> read_start_file(std::filesystem::path const& path, Lattice const& lattice,
                                    SiteBox const& box);

/// Returns 0 for the sites of a box whose spin in the file is the zero vector, and 1 for the
/// others.
std::vector<double> sites_with_spins(std::filesystem::path const& path, Lattice const& lattice,
                                     SiteBox const& box);

/// Returns true for a file with spins, and false for one with site-dependent numbers, which an HDF5
/// file has in /values.
bool holds_spins(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_2::io::detail
