// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {

/// Returns the path of a key without quotes and spaces, and with indices without leading zeros:
/// field.applied.2 for field."applied".02. Two paths of the same key then are equal.
std::string plain_path(std::string_view path);

}  // namespace cayspin::inline v0_2::io
