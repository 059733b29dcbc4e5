# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# cmake -DKOKKOS_SOURCE=DIR -P mend_kokkos_cuda13.cmake
# Kokkos 4.7.0 does not build with CUDA 13, which changed two signatures and dropped sm_70, the
# default of nvcc_wrapper. Its Views have members marked [[no_unique_address]], which nvcc 12.9 and
# 13 lay out differently for host and device, so that kernels cannot use a View. Patches a source
# tree in place; leaves a patched tree and other versions unchanged.
cmake_policy(VERSION 3.25)

# replace_once(<file> <old> <new>) replaces old by new. Does nothing if the file already holds new;
# otherwise stops unless it holds old exactly once.
function(replace_once file old new)
  file(READ "${file}" text)
  string(FIND "${text}" "${new}" mended)
  if(NOT mended EQUAL -1)
    return()
  endif()
  string(FIND "${text}" "${old}" first)
  string(FIND "${text}" "${old}" last REVERSE)
  if(first EQUAL -1 OR NOT first EQUAL last)
    message(FATAL_ERROR "${file}: expected exactly once:\n${old}")
  endif()
  string(REPLACE "${old}" "${new}" text "${text}")
  file(WRITE "${file}" "${text}")
  message(STATUS "mended for CUDA 13: ${file}")
endfunction()

file(READ "${KOKKOS_SOURCE}/CMakeLists.txt" lists)
foreach(part MAJOR MINOR PATCH)
  string(REGEX MATCH "set\\(Kokkos_VERSION_${part} ([0-9]+)\\)" ignored "${lists}")
  list(APPEND version ${CMAKE_MATCH_1})
endforeach()
list(JOIN version "." version)
if(NOT version VERSION_EQUAL 4.7.0)
  message(STATUS "Kokkos ${version}: nothing to mend for CUDA 13")
  return()
endif()

set(instance "${KOKKOS_SOURCE}/core/src/Cuda/Kokkos_Cuda_Instance.hpp")
replace_once(
  "${instance}"
  "    return cudaGraphAddDependencies(graph, from, to, numDependencies);
"
  "#if CUDART_VERSION >= 13000
    return cudaGraphAddDependencies(graph, from, to, nullptr, numDependencies);
#else
    return cudaGraphAddDependencies(graph, from, to, numDependencies);
#endif
")
replace_once(
  "${instance}"
  "    return cudaMemPrefetchAsync(devPtr, count, dstDevice, m_stream);
"
  "#if CUDART_VERSION >= 13000
    cudaMemLocation const location = {cudaMemLocationTypeDevice, dstDevice};
    return cudaMemPrefetchAsync(devPtr, count, location, 0, m_stream);
#else
    return cudaMemPrefetchAsync(devPtr, count, dstDevice, m_stream);
#endif
")
replace_once("${KOKKOS_SOURCE}/tpls/mdspan/include/experimental/__p0009_bits/config.hpp"
             "(!defined(__NVCC__) || MDSPAN_HAS_CXX_20) && " "!defined(__NVCC__) && ")
replace_once("${KOKKOS_SOURCE}/bin/nvcc_wrapper" "\ndefault_arch=\"sm_70\"\n"
             "\ndefault_arch=\"sm_80\"\n")
