# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Without an installed Kokkos under pip: its source, built inside the wheel's build.
option(CAYSPIN_X86_64_V3 "Wheels for any x86-64 with AVX2, not for this processor alone" OFF)
if(NOT CAYSPIN_KOKKOS_SOURCE)
  message(STATUS "No Kokkos is installed: fetch its source")
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
if(CAYSPIN_X86_64_V3)
  set(Kokkos_ARCH_HSW ON) # -march=haswell: x86-64-v3 and nothing that a compiler uses by itself
else()
  set(Kokkos_ARCH_NATIVE ON)
endif()
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CAYSPIN_KOKKOS_AS_UNITY ON) # a quarter of the processor time
