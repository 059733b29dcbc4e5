// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>

namespace cayspin::inline v0_2::io {

// Each function that returns an int returns 0, or the system's error number.

int write_all(int file, void const* data, std::size_t bytes, std::uint64_t offset);

/// Bytes beyond the end of the file are read as zeros.
int read_all(int file, void* data, std::size_t bytes, std::uint64_t offset);

/// Waits until the written data and the size of the file would survive a power cut. A file of a
/// kind that cannot be synchronised counts as synchronised.
int sync_file(int file);

/// Waits until the names of the files in the folder of `path` would survive a power cut. A folder
/// that may not be read or cannot be synchronised counts as synchronised.
int sync_folder_of(std::filesystem::path const& path);

/// Returns the file that symbolic links at `path` lead to, which need not exist.
std::filesystem::path followed(std::filesystem::path path);

}  // namespace cayspin::inline v0_2::io
