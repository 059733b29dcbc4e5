// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

// The execution spaces that the program is compiled for: Kokkos' default on the host, and a device
// if Kokkos has one. CAYSPIN_FOR_EACH_SPACE(apply, ...) expands apply(Space, ...). With the
// emulated device of the tests, it expands only for that device, which halves the time to compile.
#if defined(CAYSPIN_HOST_DEVICE)
#define CAYSPIN_ON_HOST(apply, ...)
#else
#define CAYSPIN_ON_HOST(apply, ...) apply(Kokkos::DefaultHostExecutionSpace, __VA_ARGS__)
#endif

#if defined(KOKKOS_ENABLE_CUDA) || defined(KOKKOS_ENABLE_HIP) || defined(KOKKOS_ENABLE_SYCL) || \
    defined(CAYSPIN_HOST_DEVICE)
#define CAYSPIN_ON_DEVICE(apply, ...) apply(Kokkos::DefaultExecutionSpace, __VA_ARGS__)
#else
#define CAYSPIN_ON_DEVICE(apply, ...)
#endif

#define CAYSPIN_FOR_EACH_SPACE(apply, ...) \
  CAYSPIN_ON_HOST(apply, __VA_ARGS__)      \
  CAYSPIN_ON_DEVICE(apply, __VA_ARGS__)
