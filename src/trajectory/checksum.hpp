// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scalar_series.hpp"

#include <cstdint>
#include <span>

namespace cayspin::inline v0_2::io {

/// Returns a 32-bit checksum of a sample and of the further numbers `more`; never 0.
std::uint32_t row_checksum(Sample const& sample, std::span<double const> more = {});

/// Returns a 32-bit checksum of a frame's sample and spins; never 0. `fletcher32`: the sum of the
/// spins.
std::uint32_t spins_checksum(Sample const& sample, std::uint32_t fletcher32);

/// Returns a number of the dataset checksum: row_checksum in the upper half, spins_checksum in the
/// lower half.
std::uint64_t frame_checksum(Sample const& sample, std::uint32_t fletcher32,
                             std::span<double const> more);

/// Returns a checksum of the texts of a header.
std::uint64_t text_checksum(TrajectoryHeader const& header);

}  // namespace cayspin::inline v0_2::io
