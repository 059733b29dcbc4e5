// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

namespace cayspin::program {

/// From here on SIGINT and SIGTERM ask a run to end after its step instead of killing it, and a
/// write past the limit of a file's size is an error like any other.
void catch_signals();

/// True once one of them came.
bool interrupt_requested();

}  // namespace cayspin::program
