// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

#if defined(__GNUC__)
#define CAYSPIN_DETAIL_NOINLINE [[gnu::noinline]]
#else
#define CAYSPIN_DETAIL_NOINLINE
#endif

// A member without an address of its own. The device code of nvcc 13.0 takes what holds one for
// larger than its host code does, and finds nothing in its place: there it has an address.
#if defined(KOKKOS_ENABLE_CUDA)
#define CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS
#else
#define CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS [[no_unique_address]]
#endif

// In front of a loop over the cells of a row, none of which is written and read.
#if defined(__CUDA_ARCH__) || defined(__HIP_DEVICE_COMPILE__)
#define CAYSPIN_DETAIL_INDEPENDENT
#elif defined(__clang__)
#define CAYSPIN_DETAIL_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define CAYSPIN_DETAIL_INDEPENDENT _Pragma("GCC ivdep")
#else
#define CAYSPIN_DETAIL_INDEPENDENT
#endif
