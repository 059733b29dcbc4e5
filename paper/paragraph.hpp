// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string_view>

namespace cayspin::paper {

/// Prints text after an empty line, broken into indented lines.
void print_paragraph(std::string_view text);

}  // namespace cayspin::paper
