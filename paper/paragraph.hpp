// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string_view>

namespace cayspin::paper {

/// Prints an empty line, and then the text, broken into indented lines.
void print_paragraph(std::string_view text);

}  // namespace cayspin::paper
