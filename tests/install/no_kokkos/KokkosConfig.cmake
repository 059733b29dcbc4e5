# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Fails like a Kokkos with CUDA 13 in CMake 3.25: see cmake/cayspinCudaToolkit.cmake.
if(CMAKE_MINIMUM_REQUIRED_VERSION VERSION_GREATER_EQUAL 3.25)
  message(FATAL_ERROR "no nvToolsExt")
endif()
add_library(Kokkos::kokkos INTERFACE IMPORTED)
