// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/io/site_box.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

namespace cayspin::inline v0_1::io::detail {

/// Throws std::runtime_error unless an HDF5 or OVF file has spins for a lattice (nx, ny, nz). Only
/// types and shapes are looked at.
void check_start_file(std::filesystem::path const& path, std::array<std::int64_t, 3> const& shape);

/// The spins of a box as they stand in the file, x fastest. Of one in OVF all is read.
std::vector<double> read_start_file(std::filesystem::path const& path,
                                    std::array<std::int64_t, 3> const& shape, SiteBox const& box);

}  // namespace cayspin::inline v0_1::io::detail
