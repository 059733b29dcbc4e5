// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "error.hpp"
#include "reading_trial.hpp"

#include <filesystem>
#include <functional>

namespace cayspin::inline v0_1::io {

/// The trial of `reading`; does nothing where none is set.
void try_before(std::filesystem::path const& path, std::function<void()> const& reading);

/// The same, but where no trial is set, `reading` is performed here.
void try_reading(std::filesystem::path const& path, std::function<void()> const& reading);

/// Throws the exception that is being handled; where memory ran out, with one line about the file.
[[noreturn]] void rethrow_reading(std::filesystem::path const& path);

/// What `reading` returns, after its trial. The same code on the same bytes does the same again.
/// `reading` must open the file itself: a file that is open already keeps its state.
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

}  // namespace cayspin::inline v0_1::io
