// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <toml++/toml.h>

#include <string>

namespace cayspin::io::detail {

/// Puts "key.path=VALUE" into the table. Missing tables are created; a whole number in the path is
/// an index into an array. Throws SceneError.
void apply_override(toml::table& root, std::string const& assignment);

}  // namespace cayspin::io::detail
