// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

namespace cayspin::io {

inline constexpr int format_version = 1;
inline constexpr char const* single_precision = "single";
inline constexpr char const* double_precision = "double";

}  // namespace cayspin::io
