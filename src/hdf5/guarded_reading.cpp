// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "guarded_reading.hpp"

#include <new>
#include <stdexcept>

namespace cayspin::inline v0_2::io {
namespace {

ReadingTrial trial_of_files = nullptr;

[[noreturn]] void throw_too_large(std::filesystem::path const& path) {
  throw_failure(path, "cannot read the file",
                "it is damaged (reading it takes more memory than there is)");
}

}  // namespace

void set_trial(ReadingTrial trial) { trial_of_files = trial; }

WithoutTrial::WithoutTrial() : before_(trial_of_files) { trial_of_files = nullptr; }
WithoutTrial::~WithoutTrial() { trial_of_files = before_; }

void try_before(std::filesystem::path const& path, std::function<void()> const& reading) {
  QuietErrors const quiet;
  if (trial_of_files) trial_of_files(path, reading);
}

void try_reading(std::filesystem::path const& path, std::function<void()> const& reading) {
  if (trial_of_files)
    try_before(path, reading);
  else
    read_guarded(path, reading);
}

void rethrow_reading(std::filesystem::path const& path) {
  try {
    throw;
  } catch (std::bad_alloc const&) {
    throw_too_large(path);
  } catch (std::length_error const&) {
    throw_too_large(path);
  }
}

}  // namespace cayspin::inline v0_2::io
