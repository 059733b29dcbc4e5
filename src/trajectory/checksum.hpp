// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scalar_series.hpp"

#include <cstdint>
#include <span>

namespace cayspin::inline v0_1::io {

/// The 32 bits that stand for step, time, scalars and, of a frame of a crystal, the means of its
/// sublattices; never 0.
std::uint32_t row_checksum(Sample const& sample, std::span<Vector const> sublattices = {});

/// The 32 bits that stand for the spins of a frame, of which `fletcher32` is given, and for the
/// sample that they belong to; never 0.
std::uint32_t spins_checksum(Sample const& sample, std::uint32_t fletcher32);

/// Of the texts of a header.
std::uint64_t text_checksum(TrajectoryHeader const& header);

}  // namespace cayspin::inline v0_1::io
