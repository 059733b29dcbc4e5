// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdio>
#include <string>

namespace cayspin::program {

/// Is it one that understands what moves the cursor?
bool is_terminal(std::FILE* stream);

/// Has the locale block characters?
bool has_blocks();

/// "[#####...................]"
std::string bar(double share);

/// How many lines the terminal shows.
int terminal_lines();

/// A line, cut where it would wrap on the terminal.
std::string fitted(std::string line);

}  // namespace cayspin::program
