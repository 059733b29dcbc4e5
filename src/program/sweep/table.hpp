// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/sweep.hpp"

namespace cayspin::program::sweep {

/// Prints a line for each run on standard output: its values, status, last frame and duration.
void print_table(io::SweepInfo const& sweep);

}  // namespace cayspin::program::sweep
