// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string_view>

namespace cayspin::simulation {

enum class Precision { double_precision, single_precision };

inline std::string_view to_string(Precision precision) {
  return precision == Precision::double_precision ? "double" : "single";
}

}  // namespace cayspin::simulation
