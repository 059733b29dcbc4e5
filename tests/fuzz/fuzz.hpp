// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <unistd.h>

#include <cstddef>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <string>

namespace cayspin::fuzz {

/// Calls `reading`, which may throw only a std::runtime_error whose message is one line. Anything
/// else ends the process.
template <class Reading>
void refuse_or_read(Reading const& reading) {
  try {
    reading();
  } catch (std::runtime_error const& error) {
    std::string const message = error.what();
    if (message.empty() || message.find('\n') != std::string::npos) std::abort();
  }
}

/// Writes these bytes to a file in memory, which each call overwrites, and returns its path.
inline std::filesystem::path file_with(std::uint8_t const* data, std::size_t bytes,
                                       char const* extension) {
  static auto const path = "/dev/shm/cayspin_fuzz_" + std::to_string(::getpid()) + extension;
  static auto const removed_at_exit = std::atexit([] { std::filesystem::remove(path); });
  static_cast<void>(removed_at_exit);
  std::ofstream(path, std::ios::binary)
      .write(reinterpret_cast<char const*>(data), static_cast<std::streamsize>(bytes));
  return path;
}

}  // namespace cayspin::fuzz
