// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <filesystem>
#include <functional>

namespace cayspin::inline v0_1::io {

/// Runs `reading` in a forked child first. A damaged file can make HDF5 crash, loop, or ask for any
/// amount of memory, and then the child alone suffers. Throws std::runtime_error with one line
/// where it does, and the child's own where `reading` threw one.
void try_in_child(std::filesystem::path const& path, std::function<void()> const& reading);

/// What `reading` returns, tried in a child before. The same code on the same bytes does the same
/// again. `reading` must open the file itself: a file that is open already keeps its state.
template <class Reading>
auto read_guarded(std::filesystem::path const& path, Reading const& reading) {
  try_in_child(path, [&] { static_cast<void>(reading()); });
  return reading();
}

}  // namespace cayspin::inline v0_1::io
