// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "method.hpp"

#include <algorithm>
#include <array>

namespace cayspin::program {

std::span<MethodEntry const> method_entries() {
  static auto const entries = std::to_array<MethodEntry>({
      euler_entry(),
      rkmk4_entry(),
      rkmk4_as_printed_entry(),
      classical_euler_entry(),
      classical_heun_entry(),
      classical_rk4_entry(),
      projected_euler_entry(),
      projected_heun_entry(),
      projected_rk4_entry(),
  });
  return entries;
}

MethodEntry const& find_method(io::Method method) {
  auto const entries = method_entries();
  auto const found = std::ranges::find(entries, method, &MethodEntry::method);
  if (found == entries.end())
    throw std::logic_error("no entry for the method " + std::string(io::to_string(method)));
  return *found;
}

}  // namespace cayspin::program
