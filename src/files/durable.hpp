// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace cayspin::inline v0_1::io {

// Each returns 0, or the system's error number.

int write_all(int file, void const* data, std::size_t bytes, std::uint64_t offset);

/// Beyond the file's end are zeros.
int read_all(int file, void* data, std::size_t bytes, std::uint64_t offset);

/// Waits until what was written, and the size, would survive a power cut. A file that knows no such
/// thing counts as synchronised.
int sync_file(int file);

/// The same of the names in the folder of `path`.
int sync_folder_of(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_1::io
