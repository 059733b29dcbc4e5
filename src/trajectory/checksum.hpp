// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scalar_series.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace cayspin::io {

/// The hash XXH64 of the library xxHash.
std::uint64_t xxh64(std::span<std::byte const> data, std::uint64_t seed = 0);

/// The 32 bits that stand for step, time and scalars; never 0.
std::uint32_t row_checksum(Sample const& sample);

/// The 32 bits that stand for the spins of a frame, which belong to this sample; never 0.
std::uint32_t spins_checksum(Sample const& sample, std::span<std::byte const> spins);

/// Of the texts of a header.
std::uint64_t text_checksum(TrajectoryHeader const& header);

}  // namespace cayspin::io
