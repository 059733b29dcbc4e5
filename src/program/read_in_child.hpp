// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <chrono>
#include <filesystem>
#include <functional>

namespace cayspin::program {

/// Runs `reading` in a forked child. A damaged file can make HDF5 crash, loop forever, or ask for
/// any amount of memory; then only the child fails. Throws std::runtime_error with a one-line
/// message if that happens, or with the child's message if `reading` threw std::runtime_error
/// there. Pass this function to io::set_trial().
void try_in_child(std::filesystem::path const& path, std::function<void()> const& reading);

/// Like the above, but with a time limit of `longest` for the child, instead of one that depends on
/// the size of the file.
void try_in_child(std::filesystem::path const& path, std::function<void()> const& reading,
                  std::chrono::milliseconds longest);

}  // namespace cayspin::program
