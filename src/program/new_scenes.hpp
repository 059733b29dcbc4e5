// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <string_view>

namespace cayspin::program {

/// A scene of the folder scenes/ that `cayspin new` writes.
struct NewScene {
  std::string_view kind, path, text;
};

extern std::array<NewScene, 5> const new_scenes;

}  // namespace cayspin::program
