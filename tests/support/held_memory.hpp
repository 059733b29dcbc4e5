// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

#include <algorithm>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <utility>

namespace cayspin::test {

/// Counts the bytes of the arrays with a prefix in their labels that are allocated during its life.
/// Only one may exist at a time.
class HeldMemory {
 public:
  explicit HeldMemory(std::string prefix) {
    state() = {std::move(prefix), {}, 0, 0};
    Kokkos::Tools::Experimental::set_allocate_data_callback(allocate);
    Kokkos::Tools::Experimental::set_deallocate_data_callback(deallocate);
  }
  ~HeldMemory() { Kokkos::Tools::Experimental::set_callbacks(before_); }
  HeldMemory(HeldMemory const&) = delete;
  HeldMemory& operator=(HeldMemory const&) = delete;

  /// Returns the largest sum so far.
  double most() const { return static_cast<double>(state().most); }

 private:
  struct State {
    std::string prefix;
    std::map<void const*, std::uint64_t> arrays;
    std::uint64_t now = 0, most = 0;
  };
  static State& state() {
    static State only;
    return only;
  }

  static void allocate(Kokkos_Profiling_SpaceHandle, char const* label, void const* data,
                       std::uint64_t bytes) {
    auto& held = state();
    if (!std::string_view(label).starts_with(held.prefix)) return;
    held.arrays[data] = bytes;
    held.now += bytes;
    held.most = std::max(held.most, held.now);
  }
  static void deallocate(Kokkos_Profiling_SpaceHandle, char const*, void const* data,
                         std::uint64_t) {
    auto& held = state();
    auto const found = held.arrays.find(data);
    if (found == held.arrays.end()) return;
    held.now -= found->second;
    held.arrays.erase(found);
  }

  decltype(Kokkos::Tools::Experimental::get_callbacks()) before_ =
      Kokkos::Tools::Experimental::get_callbacks();
};

}  // namespace cayspin::test
