// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace cayspin::inline v0_2::detail {

/// True for host spaces, whose kernels run along rows in packs. Device kernels work on single
/// sites.
template <class Exec>
inline constexpr bool is_host_execution =
    std::is_same_v<typename Exec::memory_space, Kokkos::HostSpace>;

/// Waits for the work queued on all instances if Exec is a device. A function whose caller passes
/// no instance must call this before it reads or writes fields, because kernels that the caller
/// launched may still be working on them.
template <class Exec>
void fence_all_instances(char const* label) {
  if constexpr (!is_host_execution<Exec>) Kokkos::fence(label);
}

/// On synchronous host spaces (is_synchronous), kernels over at most this many sites run on the
/// calling thread, since waking other threads would take longer.
inline constexpr std::int64_t calling_thread_sites = 2048;

/// True for host spaces that finish a kernel before the launch returns.
template <class Exec>
inline constexpr bool is_synchronous =
#if defined(KOKKOS_ENABLE_SERIAL)
    std::is_same_v<Exec, Kokkos::Serial> ||
#endif
#if defined(KOKKOS_ENABLE_OPENMP)
    std::is_same_v<Exec, Kokkos::OpenMP> ||
#endif
#if defined(KOKKOS_ENABLE_THREADS)
    std::is_same_v<Exec, Kokkos::Threads> ||
#endif
    false;

/// While an object exists, synchronous host spaces run all kernels of the thread that made it on
/// that thread, for callers that give each thread a field of its own.
class KernelsStayOnThread {
 public:
  KernelsStayOnThread() : before_(stay_) { stay_ = true; }
  ~KernelsStayOnThread() { stay_ = before_; }
  KernelsStayOnThread(KernelsStayOnThread const&) = delete;
  KernelsStayOnThread& operator=(KernelsStayOnThread const&) = delete;

  static bool here() { return stay_; }

 private:
  static inline thread_local constinit bool stay_ = false;
  bool before_;
};

/// Returns true if a kernel over this many sites runs on the calling thread.
template <class Exec>
bool runs_on_calling_thread(std::int64_t sites) {
  return is_synchronous<Exec> && (sites <= calling_thread_sites || KernelsStayOnThread::here());
}

/// The execution space under which Kokkos' profiling tools see kernels that run on the calling
/// thread.
#if defined(KOKKOS_ENABLE_SERIAL)
using CallingThread = Kokkos::Serial;
#else
using CallingThread = Kokkos::DefaultHostExecutionSpace;
#endif

/// A type-erased body, so that Kokkos' launch code is compiled once for all kernels.
struct HostTask {
  void const* body;
  void (*run)(void const* body, std::int64_t task);

  void operator()(std::int64_t task) const { run(body, task); }

  template <class Body>
  static HostTask of(Body const& body) {
    return {&body, [](void const* address, std::int64_t task) {
              (*static_cast<Body const*>(address))(task);
            }};
  }
};

using TaskIndex = Kokkos::IndexType<std::int64_t>;

template <class Exec>
CAYSPIN_DETAIL_NOINLINE void run_tasks(Exec const& exec, std::string const& label,
                                       std::int64_t count, std::int64_t sites,
                                       HostTask const& task) {
  if (runs_on_calling_thread<Exec>(sites)) {
    if (!Kokkos::Tools::profileLibraryLoaded()) {
      // A launch by Kokkos would cost as much as a small kernel.
      for (std::int64_t i = 0; i < count; ++i) task(i);
      return;
    }
    Kokkos::parallel_for(label, Kokkos::RangePolicy<CallingThread, TaskIndex>(0, count), task);
    return;
  }
  Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec, TaskIndex>(exec, 0, count), task);
}

/// Calls body(0) .. body(count - 1) on the threads of a space. Kernels over few `sites` run on the
/// calling thread if the space finishes a kernel before the launch returns.
template <class Exec, class Body>
void for_each_task(Exec const& exec, std::string const& label, std::int64_t count,
                   std::int64_t sites, Body const& body) {
  if constexpr (is_synchronous<Exec>)
    run_tasks(exec, label, count, sites, HostTask::of(body));
  else
    Kokkos::parallel_for(label, Kokkos::RangePolicy<Exec, TaskIndex>(exec, 0, count), body);
}

template <class Exec, class MemorySpace>
constexpr void check_access() {
  static_assert(Kokkos::is_execution_space_v<Exec>,
                "The first argument of a cayspin function is a Kokkos execution space instance.");
  static_assert(bool(Kokkos::SpaceAccessibility<Exec, MemorySpace>::accessible),
                "This execution space cannot reach the memory space of the field or View.");
}

/// Throws std::invalid_argument for a default-constructed or moved-from field.
inline void require_sites(std::string const& where, std::int64_t sites) {
  if (sites == 0) [[unlikely]]
    throw std::invalid_argument(where + ": the field has no sites");
}

template <class View>
void require_extents(char const* where, View const& view, std::int64_t sites, int components) {
  require_sites(where, sites);
  if (static_cast<std::int64_t>(view.extent(0)) != sites ||
      static_cast<int>(view.extent(1)) != components)
    throw std::invalid_argument(std::string(where) + ": the View is " +
                                std::to_string(view.extent(0)) + " x " +
                                std::to_string(view.extent(1)) + ", the field " +
                                std::to_string(sites) + " x " + std::to_string(components));
  if (view.data() == nullptr)
    throw std::invalid_argument(std::string(where) + ": the View has no memory");
}

inline void require_size(char const* where, std::size_t size, std::int64_t expected) {
  if (static_cast<std::int64_t>(size) != expected)
    throw std::invalid_argument(std::string(where) + ": " + std::to_string(size) +
                                " numbers for a field of " + std::to_string(expected));
}

}  // namespace cayspin::inline v0_2::detail
