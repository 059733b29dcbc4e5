// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

#include <string>
#include <vector>

namespace cayspin::inline v0_2::detail {

/// Returns a View in MemorySpace with copies of the elements, and waits until they are copied.
template <class MemorySpace, class Element>
Kokkos::View<Element*, MemorySpace> table_of(std::string const& label,
                                             std::vector<Element> const& elements) {
  Kokkos::View<Element*, MemorySpace> table(Kokkos::view_alloc(Kokkos::WithoutInitializing, label),
                                            elements.size());
  // Without an execution space instance, deep_copy would wait for all instances. If this function
  // is called from within a kernel, that wait would never end.
  typename MemorySpace::execution_space const exec;
  Kokkos::View<Element const*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> const host(
      elements.data(), elements.size());
  Kokkos::deep_copy(exec, table, host);
  exec.fence("cayspin::table_of");
  return table;
}

}  // namespace cayspin::inline v0_2::detail
