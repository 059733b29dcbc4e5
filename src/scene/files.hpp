// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5_dataset.hpp"

#include <array>
#include <cstdint>

namespace cayspin::io::detail {

/// Checks that /spins has the lattice's shape, with or without a frame axis in front.
/// Throws std::runtime_error with one line.
void check_spins(Hdf5Dataset const& spins, std::array<std::int64_t, 3> const& shape);

/// Checks that /inertia is (count, 3, 3). Throws std::runtime_error with one line.
void check_inertia(Hdf5Dataset const& inertia, std::int64_t count);

}  // namespace cayspin::io::detail
