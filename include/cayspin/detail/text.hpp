// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdio>
#include <string>

namespace cayspin::inline v0_1::detail {

/// A number for a message, to nine digits: 1e-12 rather than 0.000000.
inline std::string to_text(double number) {
  char text[32];
  std::snprintf(text, sizeof text, "%.9g", number);
  return text;
}

}  // namespace cayspin::inline v0_1::detail
