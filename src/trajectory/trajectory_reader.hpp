// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/handle.hpp"
#include "io/trajectory.hpp"

#include <filesystem>

namespace cayspin::inline v0_1::io {

/// Attributes and extents; the scalars are not read, and `frames` are those that have spins.
TrajectoryInfo read_header(hid_t file, std::filesystem::path const& path);

}  // namespace cayspin::inline v0_1::io
