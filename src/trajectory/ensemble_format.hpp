// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>

namespace cayspin::inline v0_2::io {

/// The attribute that identifies the file of an ensemble, and its value.
inline constexpr char const* ensemble_format = "ensemble_format";
inline constexpr std::int64_t ensemble_format_version = 1;

}  // namespace cayspin::inline v0_2::io
