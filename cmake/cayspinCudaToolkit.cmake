# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# cayspin_find_with_cuda(<arguments of find_package>...)
# Finds CUDAToolkit, or a package that looks for it, as a Kokkos with CUDA does. In a project that
# requires CMake 3.25 or newer, CMake's module marks nvToolsExt as deprecated, and in some versions
# of CMake it fails if there is none. CUDA 13 has none.
macro(cayspin_find_with_cuda)
  set(cayspin_required_cmake ${CMAKE_MINIMUM_REQUIRED_VERSION})
  set(CMAKE_MINIMUM_REQUIRED_VERSION 3.24)
  find_package(${ARGN})
  set(CMAKE_MINIMUM_REQUIRED_VERSION ${cayspin_required_cmake})
endmacro()
