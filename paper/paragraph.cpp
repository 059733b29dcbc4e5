// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "paragraph.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace cayspin::paper {

void print_paragraph(std::string_view text) {
  constexpr std::size_t width = 116;
  fmt::print("\n");
  while (!text.empty()) {
    auto end = text.size();
    if (end > width) end = text.rfind(' ', width);
    // A word longer than a line gets its own line.
    if (end == text.npos) end = std::min(text.find(' '), text.size());
    fmt::print("  {}\n", text.substr(0, end));
    text.remove_prefix(std::min(text.size(), end + 1));
  }
}

}  // namespace cayspin::paper
