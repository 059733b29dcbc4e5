// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <filesystem>
#include <functional>

namespace cayspin::inline v0_2::io {

/// Runs `reading`, which reads a file that may be damaged, where a crash does no harm, for example
/// in another process. Throws std::runtime_error with one line if the file must not be read. No
/// other thread of the library uses HDF5 while it runs.
using ReadingTrial = void (*)(std::filesystem::path const& path,
                              std::function<void()> const& reading);

/// Sets the trial to run before each reading. There is none by default, because a library must not
/// start processes. Call it before other threads read files.
void set_trial(ReadingTrial trial);

/// While in scope, files are read without a trial. For files that this program has just written. No
/// other thread may read.
class WithoutTrial {
 public:
  WithoutTrial();
  ~WithoutTrial();
  WithoutTrial(WithoutTrial const&) = delete;
  WithoutTrial& operator=(WithoutTrial const&) = delete;

 private:
  ReadingTrial before_;
};

}  // namespace cayspin::inline v0_2::io
