// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>

namespace cayspin::program {

/// Runs `reading` in a forked child. A damaged file can make HDF5 crash, loop, or ask for any
/// amount of memory, and then only the child suffers. Throws std::runtime_error with one line where
/// it does, and the child's own where `reading` threw one. A trial for io::set_trial().
void try_in_child(std::filesystem::path const& path, std::function<void()> const& reading);

/// The same. A child that does not end within `longest` is killed.
void try_in_child(std::filesystem::path const& path, std::function<void()> const& reading,
                  std::chrono::milliseconds longest);

}  // namespace cayspin::program
