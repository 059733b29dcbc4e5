// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

namespace cayspin::program {

/// Waits for a child process that is about to end, and returns its status as waitpid() gives it. If
/// the child has not ended within `longest`, kills it. Returns nothing if waitpid() fails, as it
/// does when SIGCHLD is ignored, or if a killed child has not ended after another 10 s.
std::optional<int> end_of_process(pid_t child,
                                  std::chrono::milliseconds longest = std::chrono::seconds(10));

}  // namespace cayspin::program
