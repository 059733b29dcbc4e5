// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace cayspin::detail {

/// Host spaces run over rows with packs, device spaces with one thread per site.
template <class Exec>
inline constexpr bool is_host_execution =
    std::is_same_v<typename Exec::memory_space, Kokkos::HostSpace>;

/// Up to this many sites a host kernel runs on the calling thread: waking the others costs more.
inline constexpr std::int64_t calling_thread_sites = 2048;

/// A host space that has finished a kernel when the launch returns, and so little to do.
template <class Exec>
bool runs_on_calling_thread(std::int64_t sites) {
#if defined(KOKKOS_ENABLE_SERIAL)
  bool synchronous = std::is_same_v<Exec, Kokkos::Serial>;
#if defined(KOKKOS_ENABLE_OPENMP)
  synchronous = synchronous || std::is_same_v<Exec, Kokkos::OpenMP>;
#endif
#if defined(KOKKOS_ENABLE_THREADS)
  synchronous = synchronous || std::is_same_v<Exec, Kokkos::Threads>;
#endif
  return synchronous && sites <= calling_thread_sites;
#else
  return false;
#endif
}

/// Runs body(0) .. body(count - 1) on a host space: on its threads, or, when there is little to do
/// for spaces that finish a kernel before they return, on the calling thread.
template <class Exec, class Body>
void for_each_task(Exec const& exec, std::string const& label, std::int64_t count,
                   std::int64_t sites, Body const& body) {
#if defined(KOKKOS_ENABLE_SERIAL)
  if (runs_on_calling_thread<Exec>(sites)) {
    using Policy = Kokkos::RangePolicy<Kokkos::Serial, Kokkos::IndexType<std::int64_t>>;
    Kokkos::parallel_for(label, Policy(0, count), body);
    return;
  }
#endif
  using Policy = Kokkos::RangePolicy<Exec, Kokkos::IndexType<std::int64_t>>;
  Kokkos::parallel_for(label, Policy(exec, 0, count), body);
}

template <class Exec, class MemorySpace>
constexpr void check_access() {
  static_assert(Kokkos::is_execution_space_v<Exec>,
                "The first argument of a cayspin function is a Kokkos execution space instance.");
  static_assert(bool(Kokkos::SpaceAccessibility<Exec, MemorySpace>::accessible),
                "This execution space cannot reach the memory space of the field or View.");
}

template <class View>
void require_extents(char const* where, View const& view, std::int64_t sites, int components) {
  if (static_cast<std::int64_t>(view.extent(0)) != sites ||
      static_cast<int>(view.extent(1)) != components)
    throw std::invalid_argument(std::string(where) + ": the View is " +
                                std::to_string(view.extent(0)) + " x " +
                                std::to_string(view.extent(1)) + ", the field " +
                                std::to_string(sites) + " x " + std::to_string(components));
}

inline void require_size(char const* where, std::size_t size, std::int64_t expected) {
  if (static_cast<std::int64_t>(size) != expected)
    throw std::invalid_argument(std::string(where) + ": " + std::to_string(size) +
                                " numbers for a field of " + std::to_string(expected));
}

}  // namespace cayspin::detail
