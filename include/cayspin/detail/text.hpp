// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <charconv>
#include <string>

namespace cayspin::inline v0_2::detail {

/// Returns the text of a number for messages, to nine significant digits: 1e-12 rather than
/// 0.000000. The decimal separator is a point in any locale.
inline std::string to_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 9).ptr};
}

}  // namespace cayspin::inline v0_2::detail
