// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// Returns a text as a string of TOML, with quotes and escapes.
std::string toml_string(std::string_view text);

}  // namespace cayspin::inline v0_2::io
