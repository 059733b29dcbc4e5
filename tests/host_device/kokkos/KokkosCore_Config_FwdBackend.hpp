// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The compiler finds this file before Kokkos' own file of the same name, which lists the backends
// of its build. This file adds the emulated device to the list and makes it the default.
#pragma once

#include_next <KokkosCore_Config_FwdBackend.hpp>

namespace cayspin::test {
class HostDevice;
class HostDeviceMemory;
}  // namespace cayspin::test

// Kokkos 4 and 5 choose the default space from a fixed list, in which the emulated device takes the
// place of OpenACC.
#define KOKKOS_ENABLE_DEFAULT_DEVICE_TYPE_OPENACC
namespace Kokkos::Experimental {
using OpenACC = cayspin::test::HostDevice;
}
