// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <sys/types.h>

#include <chrono>
#include <optional>

namespace cayspin::program {

/// Returns the status of a child that is about to end, as waitpid() gives it. If the child has not
/// ended within `longest`, kills it. Returns nothing if there is no status, or if the system does
/// not end the child within another 10 s.
std::optional<int> end_of_process(pid_t child,
                                  std::chrono::milliseconds longest = std::chrono::seconds(10));

}  // namespace cayspin::program
