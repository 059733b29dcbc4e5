// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

// A member without an address of its own. The device code of nvcc 13.0 takes what holds one for
// larger than its host code does, and finds nothing in its place: there it has an address.
#if defined(KOKKOS_ENABLE_CUDA)
#define CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS
#else
#define CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS [[no_unique_address]]
#endif
