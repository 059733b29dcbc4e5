// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <filesystem>
#include <functional>

namespace cayspin::inline v0_1::io {

/// Performs `reading` of a file that may be damaged where a crash does no harm, such as in another
/// process. Throws std::runtime_error with one line where the file must not be read. No other
/// thread of the library uses HDF5 while it runs.
using ReadingTrial = void (*)(std::filesystem::path const& path,
                              std::function<void()> const& reading);

/// Sets what comes before each reading. By default there is no trial: a library must not start
/// processes. To be set before other threads read files.
void set_trial(ReadingTrial trial);

}  // namespace cayspin::inline v0_1::io
