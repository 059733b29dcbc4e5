// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// A device emulated by the host's threads, for tests without a real one. It is as strict as a
// device may be: kernels and copies wait in a queue until a fence or until the queue is full, and
// only kernels and copies can access its memory, so that a host dereference ends the program.
#pragma once

#include <Kokkos_Concepts.hpp>
#include <Kokkos_Core_fwd.hpp>
#include <Kokkos_HostSpace.hpp>
#include <Kokkos_Layout.hpp>
#include <Kokkos_ScratchSpace.hpp>
#include <impl/Kokkos_FunctorAnalysis.hpp>
#include <impl/Kokkos_InitializationSettings.hpp>
#include <impl/Kokkos_Tools.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <iosfwd>
#include <memory>
#include <string>
#include <vector>

namespace cayspin::test {

/// Queued work of an instance.
class HostDeviceQueue;

class HostDeviceMemory {
 public:
  using memory_space = HostDeviceMemory;
  using execution_space = HostDevice;
  using device_type = Kokkos::Device<execution_space, memory_space>;
  using size_type = std::size_t;

  void* allocate(std::size_t bytes) const { return allocate("[unlabeled]", bytes); }
  void* allocate(char const* label, std::size_t bytes, std::size_t logical_bytes = 0) const;
  template <class Exec>
  void* allocate(Exec const&, char const* label, std::size_t bytes,
                 std::size_t logical_bytes = 0) const {
    return allocate(label, bytes, logical_bytes);
  }
  void deallocate(void* address, std::size_t bytes) const {
    deallocate("[unlabeled]", address, bytes);
  }
  void deallocate(char const* label, void* address, std::size_t bytes,
                  std::size_t logical_bytes = 0) const;

  static constexpr char const* name() { return "HostDeviceMemory"; }
};

/// An execution space. Each instance that with_own_queue() returns has its own queue;
/// default-constructed instances share one queue.
class HostDevice {
 public:
  using execution_space = HostDevice;
  using memory_space = HostDeviceMemory;
  using device_type = Kokkos::Device<execution_space, memory_space>;
  using size_type = std::size_t;
  using array_layout = Kokkos::LayoutLeft;
  using scratch_memory_space = Kokkos::ScratchMemorySpace<HostDevice>;

  HostDevice();
  static HostDevice with_own_queue();

  void fence(std::string const& name = "HostDevice::fence: unnamed") const;
  /// Queues `task` after this instance's earlier work. It runs at the next fence, or earlier if the
  /// queue is full or much memory is freed.
  void enqueue(std::function<void()> task) const;
  int concurrency() const;
  std::uint32_t impl_instance_id() const noexcept;
  void print_configuration(std::ostream& out, bool verbose = false) const;
  /// In lower case, this is the name for --space.
  static char const* name() { return "Host_Device"; }

  static void impl_static_fence(std::string const& name);
  static void impl_initialize(Kokkos::InitializationSettings const&);
  static bool impl_is_initialized();
  static void impl_finalize();

  friend bool operator==(HostDevice const&, HostDevice const&) = default;

 private:
  explicit HostDevice(std::shared_ptr<HostDeviceQueue> queue) : queue_(std::move(queue)) {}
  std::shared_ptr<HostDeviceQueue> queue_;
};

/// While such an object exists, the device's memory can be accessed. Kernels and copies make one.
class HostDeviceAccess {
 public:
  HostDeviceAccess();
  ~HostDeviceAccess();
  HostDeviceAccess(HostDeviceAccess const&) = delete;
  HostDeviceAccess& operator=(HostDeviceAccess const&) = delete;
};

/// Ends the program with this message unless a kernel or copy is running.
void require_kernel(char const* message);

/// Copies between the device and the host, or within the device.
void copy_now(void* to, void const* from, std::size_t bytes);

template <class Exec>
void copy_in_order(Exec const& exec, void* to, void const* from, std::size_t bytes) {
  if constexpr (std::is_same_v<Exec, HostDevice>) {
    exec.enqueue([=] { copy_now(to, from, bytes); });
  } else {
    exec.fence("HostDevice: before a copy");
    copy_now(to, from, bytes);
  }
}

/// Calls run(body, begin, end) for blocks of 0 .. count - 1 on host threads. If there are at most
/// two blocks, makes one call for all.
void run_blocks(std::int64_t count, std::int64_t block, void const* body,
                void (*run)(void const* body, std::int64_t begin, std::int64_t end));

}  // namespace cayspin::test
