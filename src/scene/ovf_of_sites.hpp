// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <vector>

namespace cayspin::inline v0_2::io::detail {

/// Throws std::runtime_error unless an OVF file has this number of components, 1 or 3, and as many
/// nodes along each axis as the lattice. Also throws for a lattice with several sites per cell.
/// Reads only the header.
void check_ovf_of_sites(std::filesystem::path const& path, Lattice const& lattice,
                        std::int64_t components);

/// Returns the values of a box, x fastest. Reads the whole file.
std::vector<double> read_ovf_of_sites(std::filesystem::path const& path, Lattice const& lattice,
                                      std::int64_t components, SiteBox const& box);

}  // namespace cayspin::inline v0_2::io::detail
