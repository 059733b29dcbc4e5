// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "error.hpp"
#include "reading_trial.hpp"

#include <filesystem>
#include <functional>

namespace cayspin::inline v0_2::io {

/// Runs `reading` in the trial that set_trial() has set; does nothing if none is set.
void try_before(std::filesystem::path const& path, std::function<void()> const& reading);

/// Runs `reading` in the trial that is set; if none is set, runs it directly.
void try_reading(std::filesystem::path const& path, std::function<void()> const& reading);

/// Rethrows the exception being handled. If memory ran out, throws a std::runtime_error about the
/// file instead.
[[noreturn]] void rethrow_reading(std::filesystem::path const& path);

/// Runs `reading` in a trial if one is set, then directly, and returns its result. `reading` must
/// open the file itself, so that it runs the same code on the same bytes both times.
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
