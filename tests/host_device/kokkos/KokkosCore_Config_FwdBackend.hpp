// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Found before Kokkos' own file of this name, which lists the backends of its build: adds one more
// and makes it the default.
#pragma once

#include_next <KokkosCore_Config_FwdBackend.hpp>

namespace cayspin::test {
class HostDevice;
class HostDeviceMemory;
}  // namespace cayspin::test

// Kokkos 4 and 5 choose the default space from a fixed list, in which this one takes the place of
// OpenACC.
#define KOKKOS_ENABLE_DEFAULT_DEVICE_TYPE_OPENACC
namespace Kokkos::Experimental {
using OpenACC = cayspin::test::HostDevice;
}
