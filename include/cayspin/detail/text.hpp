// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <charconv>
#include <string>

namespace cayspin::inline v0_1::detail {

/// A number for a message, to nine digits: 1e-12 rather than 0.000000. With a decimal point,
/// whatever the locale of the program has.
inline std::string to_text(double number) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, number, std::chars_format::general, 9).ptr};
}

}  // namespace cayspin::inline v0_1::detail
