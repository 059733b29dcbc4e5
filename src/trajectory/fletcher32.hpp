// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <cstdint>

namespace cayspin::io {

/// The checksum of HDF5's filter fletcher32, for an even number of bytes.
std::uint32_t fletcher32(std::byte const* data, std::size_t bytes);

}  // namespace cayspin::io
