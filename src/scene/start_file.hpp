// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <filesystem>
#include <vector>

namespace cayspin::inline v0_2::io::detail {

/// Throws std::runtime_error unless an HDF5 or OVF file has spins for a lattice. Checks only types
/// and shapes.
void check_start_file(std::filesystem::path const& path, Lattice const& lattice);

/// Returns the spins of a box as stored in the file, x fastest. Reads an OVF file completely.
std::vector<double> read_start_file(std::filesystem::path const& path, Lattice const& lattice,
                                    SiteBox const& box);

/// Returns 0 where the spin is the zero vector, and 1 elsewhere.
std::vector<double> sites_with_spins(std::filesystem::path const& path, Lattice const& lattice,
                                     SiteBox const& box);

/// Returns true for a file with spins, and false for one with site-dependent numbers.
bool holds_spins(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_2::io::detail
