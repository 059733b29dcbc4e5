// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Traits that Kokkos needs of an execution space and a memory space, for host_device.hpp.
#pragma once

#include "host_device.hpp"

KOKKOS_IMPL_HOST_INACCESSIBLE_SHARED_ALLOCATION_SPECIALIZATION(cayspin::test::HostDeviceMemory);

namespace Kokkos {

namespace Experimental::simd_abi {
class scalar;
namespace Impl {
template <class>
struct ForSpace;
template <>
struct ForSpace<cayspin::test::HostDevice> {
  template <class>
  using type = scalar;
  template <int>
  using simd_abi = scalar;
};
}  // namespace Impl
}  // namespace Experimental::simd_abi

namespace Tools::Experimental {
template <>
struct DeviceTypeTraits<cayspin::test::HostDevice> {
  static constexpr DeviceType id = DeviceType::Unknown;
  static int device_id(cayspin::test::HostDevice const&) { return 0; }
};
}  // namespace Tools::Experimental

namespace Experimental::Impl {
template <class Weight>
std::vector<cayspin::test::HostDevice> impl_partition_space(cayspin::test::HostDevice const&,
                                                            std::vector<Weight> const& weights) {
  std::vector<cayspin::test::HostDevice> instances;
  for (std::size_t i = 0; i < weights.size(); ++i)
    instances.push_back(cayspin::test::HostDevice::with_own_queue());
  return instances;
}
}  // namespace Experimental::Impl

namespace Impl {

// Before each access, Views ask whether the host may reach their memory: it may during a kernel or
// a copy.
template <class, class, bool>
struct RuntimeCheckBasicViewMemoryAccessViolation;
template <>
struct RuntimeCheckBasicViewMemoryAccessViolation<cayspin::test::HostDeviceMemory,
                                                  DefaultHostExecutionSpace, false> {
  template <class Tracker>
  explicit RuntimeCheckBasicViewMemoryAccessViolation(Tracker const&) {
    cayspin::test::require_kernel("HostDevice: host code reads or writes a View on the device");
  }
};
template <>
struct RuntimeCheckMemoryAccessViolation<cayspin::test::HostDeviceMemory, DefaultHostExecutionSpace,
                                         false> {
  explicit RuntimeCheckMemoryAccessViolation(char const* message) {
    cayspin::test::require_kernel(message);
  }
};

template <>
struct MemorySpaceAccess<HostSpace, cayspin::test::HostDeviceMemory> {
  enum : bool { assignable = false, accessible = false, deepcopy = true };
};
template <>
struct MemorySpaceAccess<cayspin::test::HostDeviceMemory, HostSpace> {
  enum : bool { assignable = false, accessible = false, deepcopy = true };
};
template <>
struct MemorySpaceAccess<cayspin::test::HostDeviceMemory,
                         ScratchMemorySpace<cayspin::test::HostDevice>> {
  enum : bool { assignable = false, accessible = true, deepcopy = false };
};

struct CopyOfHostDevice {
  CopyOfHostDevice(void* to, void const* from, std::size_t bytes) {
    cayspin::test::HostDevice::impl_static_fence("HostDevice: before a copy");
    cayspin::test::copy_now(to, from, bytes);
  }
  template <class Exec>
  CopyOfHostDevice(Exec const& exec, void* to, void const* from, std::size_t bytes) {
    cayspin::test::copy_in_order(exec, to, from, bytes);
  }
};
template <class Exec>
struct DeepCopy<cayspin::test::HostDeviceMemory, cayspin::test::HostDeviceMemory, Exec>
    : CopyOfHostDevice {
  using CopyOfHostDevice::CopyOfHostDevice;
};
template <class Exec>
struct DeepCopy<cayspin::test::HostDeviceMemory, HostSpace, Exec> : CopyOfHostDevice {
  using CopyOfHostDevice::CopyOfHostDevice;
};
template <class Exec>
struct DeepCopy<HostSpace, cayspin::test::HostDeviceMemory, Exec> : CopyOfHostDevice {
  using CopyOfHostDevice::CopyOfHostDevice;
};

}  // namespace Impl
}  // namespace Kokkos
