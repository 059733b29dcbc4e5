// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <filesystem>
#include <functional>

namespace cayspin::inline v0_2::io {

/// Function that tries `reading` on a file that may be damaged. It runs `reading` where a crash
/// does no harm, for example in another process. Throws std::runtime_error with a one-line message
/// if the file must not be read. Meanwhile no other thread of the library uses HDF5.
using ReadingTrial = void (*)(std::filesystem::path const& path,
                              std::function<void()> const& reading);

/// Sets the trial to run before each reading. There is none by default, because a library must not
/// start processes. Call set_trial before other threads read files.
void set_trial(ReadingTrial trial);

/// While in scope, files are read without a trial. Use it only for files that this program has just
/// written. No other thread may read files meanwhile.
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
