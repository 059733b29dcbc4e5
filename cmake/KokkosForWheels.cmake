# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Builds Kokkos from source within the build of a wheel, if none is installed, or if the wheel is
# not for this processor only.
if(NOT CAYSPIN_KOKKOS_SOURCE)
  message(STATUS "fetch Kokkos' source")
  execute_process(COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/bootstrap.sh kokkos-source
                  RESULT_VARIABLE status)
  if(status)
    message(
      FATAL_ERROR "cayspin needs Kokkos: run `bash cmake/bootstrap.sh deps`, then this again.")
  endif()
  set(CAYSPIN_KOKKOS_SOURCE ${PROJECT_SOURCE_DIR}/.deps/kokkos-source)
endif()
set(Kokkos_ENABLE_OPENMP ON)
set(Kokkos_ENABLE_SERIAL ON)
# Kokkos passes -march=haswell or -march=skylake-avx512. These options go beyond the levels
# x86-64-v3 and x86-64-v4, but only by instructions that compilers do not use by themselves.
set(architecture_of_native NATIVE)
set(architecture_of_x86-64-v3 HSW)
set(architecture_of_x86-64-v4 SKX)
if(architecture_of_${CAYSPIN_PROCESSOR})
  set(Kokkos_ARCH_${architecture_of_${CAYSPIN_PROCESSOR}} ON)
endif()
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CAYSPIN_KOKKOS_AS_UNITY ON) # Kokkos then takes a quarter of the processor time
