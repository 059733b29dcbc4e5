// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

// The execution spaces that the program is compiled for: the threaded host space, Serial, and a
// device, as far as Kokkos has them. CAYSPIN_FOR_EACH_*(apply, ...) expands apply(Space, ...).
// On the host device of the tests it is compiled for that alone, in half the time.
#if defined(CAYSPIN_HOST_DEVICE)
#define CAYSPIN_ON_HOST(apply, ...)
#else
#define CAYSPIN_ON_HOST(apply, ...) apply(Kokkos::DefaultHostExecutionSpace, __VA_ARGS__)
#endif

#if defined(KOKKOS_ENABLE_SERIAL) && !defined(CAYSPIN_WITHOUT_SERIAL) && \
    (defined(KOKKOS_ENABLE_OPENMP) || defined(KOKKOS_ENABLE_THREADS) ||  \
     defined(KOKKOS_ENABLE_HPX))
#define CAYSPIN_ON_SERIAL(apply, ...) apply(Kokkos::Serial, __VA_ARGS__)
#else
#define CAYSPIN_ON_SERIAL(apply, ...)
#endif

#if defined(KOKKOS_ENABLE_CUDA) || defined(KOKKOS_ENABLE_HIP) || defined(KOKKOS_ENABLE_SYCL) || \
    defined(CAYSPIN_HOST_DEVICE)
#define CAYSPIN_ON_DEVICE(apply, ...) apply(Kokkos::DefaultExecutionSpace, __VA_ARGS__)
#else
#define CAYSPIN_ON_DEVICE(apply, ...)
#endif

#define CAYSPIN_FOR_EACH_SPACE(apply, ...) \
  CAYSPIN_ON_HOST(apply, __VA_ARGS__)      \
  CAYSPIN_ON_SERIAL(apply, __VA_ARGS__)    \
  CAYSPIN_ON_DEVICE(apply, __VA_ARGS__)

#define CAYSPIN_FOR_EACH_MEMORY(apply, ...) \
  CAYSPIN_ON_HOST(apply, __VA_ARGS__)       \
  CAYSPIN_ON_DEVICE(apply, __VA_ARGS__)
