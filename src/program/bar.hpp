// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdio>
#include <string>

namespace cayspin::program {

/// Is it one that understands what moves the cursor?
bool is_terminal(std::FILE* stream);

/// "[#####...................]"
std::string bar(double share);

/// A line, cut where it would wrap on the terminal.
std::string fitted(std::string line);

}  // namespace cayspin::program
