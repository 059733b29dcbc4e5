// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdio>
#include <string>

namespace cayspin::program {

/// Returns true if the stream is a terminal, which is assumed to understand cursor movements.
bool is_terminal(std::FILE* stream);

/// Returns true if the locale has block characters.
bool has_blocks();

/// Returns "[#####...................]", for example.
std::string bar(double share);

/// Returns how many lines the terminal shows.
int terminal_lines();

/// Returns a line, cut where it would wrap on the terminal.
std::string fitted(std::string line);

}  // namespace cayspin::program
