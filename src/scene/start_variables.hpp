// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string>
#include <vector>

namespace cayspin::io::detail {

/// What an expression in [initial] may use: the position (index + 1/2)/extent and the indices.
inline std::vector<std::string> start_variables() { return {"x", "y", "z", "i", "j", "k"}; }

}  // namespace cayspin::io::detail
