// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "simulation/method_list.hpp"

#include <algorithm>
#include <array>

namespace cayspin::inline v0_2::io {

std::span<Method const* const> methods() {
  static constexpr auto all =
      std::apply([](auto const&... row) { return std::to_array<Method const*>({&row...}); },
                 simulation::method_list);
  return all;
}

Method const* find_method(std::string_view word) {
  auto const found = std::ranges::find(methods(), word, &Method::word);
  return found == methods().end() ? nullptr : *found;
}

}  // namespace cayspin::inline v0_2::io
