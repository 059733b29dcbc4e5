// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdio>
#include <string>

namespace cayspin::program {

/// Returns true if the stream is a terminal. Any terminal is assumed to understand the escape
/// sequences that move its cursor.
bool is_terminal(std::FILE* stream);

/// Returns true if the encoding of the locale is UTF-8, which has block characters.
bool has_blocks();

/// Returns a progress bar such as "[#####...................]". `share`: the fraction that is done,
/// 0 to 1.
std::string bar(double share);

/// Returns the number of lines of the terminal, or 24 if it is unknown.
int terminal_lines();

/// Returns the line, cut so that it does not wrap on the terminal.
std::string fitted(std::string line);

}  // namespace cayspin::program
