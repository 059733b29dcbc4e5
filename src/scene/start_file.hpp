// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <filesystem>
#include <vector>

namespace cayspin::inline v0_1::io::detail {

/// Throws std::runtime_error unless an HDF5 or OVF file has spins for a lattice. Only types and
/// shapes are looked at.
void check_start_file(std::filesystem::path const& path, Lattice const& lattice);

/// The spins of a box as they stand in the file, x fastest. Of one in OVF all is read.
std::vector<double> read_start_file(std::filesystem::path const& path, Lattice const& lattice,
                                    SiteBox const& box);

/// 0 where that spin is the zero vector, and 1 elsewhere.
std::vector<double> sites_with_spins(std::filesystem::path const& path, Lattice const& lattice,
                                     SiteBox const& box);

/// Does a file hold spins, and no numbers of sites?
bool holds_spins(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_1::io::detail
