// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "error.hpp"
#include "reading_trial.hpp"

#include <filesystem>
#include <functional>

namespace cayspin::inline v0_2::io {

/// Runs the trial of `reading`; does nothing if none is set.
void try_before(std::filesystem::path const& path, std::function<void()> const& reading);

/// Runs the trial of `reading`; if none is set, runs `reading` itself.
void try_reading(std::filesystem::path const& path, std::function<void()> const& reading);

/// Rethrows the exception being handled; if memory ran out, as one line about the file.
[[noreturn]] void rethrow_reading(std::filesystem::path const& path);

/// Returns the result of `reading` after its trial, which has run equal code on equal bytes.
/// `reading` must open the file itself: a file that is already open keeps its state.
template <class Reading>
auto read_guarded(std::filesystem::path const& path, Reading const& reading) {
  QuietErrors const quiet;
  try_before(path, [&] { static_cast<void>(reading()); });
  try {
    return reading();
  } catch (...) {
    rethrow_reading(path);
  }
}

}  // namespace cayspin::inline v0_2::io
