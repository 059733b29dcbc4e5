// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <hdf5.h>

#include <filesystem>
#include <vector>

namespace cayspin::inline v0_2::io {

/// Writes the dataset /positions: x, y and z of each site. It has HDF5's own checksums, because the
/// checksums of frames do not cover it.
void write_positions(hid_t file, TrajectoryHeader const& header,
                     std::vector<double> const& positions, std::filesystem::path const& path);

}  // namespace cayspin::inline v0_2::io
