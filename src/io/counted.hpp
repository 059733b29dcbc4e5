// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// Returns the count and the noun, which has an "s" unless the count is 1: "1 step", "2 steps".
inline std::string counted(std::int64_t count, std::string_view what) {
  auto text = std::to_string(count);
  text += ' ';
  text += what;
  if (count != 1) text += 's';
  return text;
}

}  // namespace cayspin::inline v0_2::io
