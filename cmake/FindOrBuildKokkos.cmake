# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Provides Kokkos::kokkos: a parent project's target, else an installed package, else a source tree.
# Sets CAYSPIN_KOKKOS_VERSION, _ORIGIN and _BACKENDS for the summary and for the tests.
include(${CMAKE_CURRENT_LIST_DIR}/cayspinCudaToolkit.cmake)
set(CAYSPIN_KOKKOS_MINIMUM 4.5)
set(CAYSPIN_KOKKOS_BEYOND 6)

if(TARGET Kokkos::kokkos)
  set(CAYSPIN_KOKKOS_ORIGIN "the parent project's")
else()
  if(SKBUILD) # pip passes no prefix: take what bootstrap.sh built
    set(built_by_bootstrap HINTS ${PROJECT_SOURCE_DIR}/.deps/kokkos)
  endif()
  if(NOT SKBUILD OR CAYSPIN_PROCESSOR STREQUAL native)
    cayspin_find_with_cuda(Kokkos ${CAYSPIN_KOKKOS_MINIMUM} CONFIG QUIET ${built_by_bootstrap})
  endif()
  if(SKBUILD AND NOT Kokkos_FOUND)
    include(${CMAKE_CURRENT_LIST_DIR}/KokkosForWheels.cmake)
  endif()
  if(Kokkos_FOUND)
    set(CAYSPIN_KOKKOS_ORIGIN "${Kokkos_DIR}")
  elseif(CAYSPIN_KOKKOS_SOURCE)
    set(CMAKE_UNITY_BUILD ${CAYSPIN_KOKKOS_AS_UNITY})
    set(position_independent ${CMAKE_POSITION_INDEPENDENT_CODE})
    if(NOT Kokkos_ENABLE_CUDA AND NOT Kokkos_ENABLE_HIP AND NOT Kokkos_ENABLE_SYCL)
      set(CMAKE_POSITION_INDEPENDENT_CODE ON) # for the shared library that it is linked into
    endif()
    if(NOT DEFINED BUILD_SHARED_LIBS) # else Kokkos' default looks like a user's choice next time
      set(BUILD_SHARED_LIBS OFF)
      set(no_choice ON)
    endif()
    add_subdirectory("${CAYSPIN_KOKKOS_SOURCE}" kokkos SYSTEM)
    if(no_choice)
      unset(BUILD_SHARED_LIBS)
    endif()
    set(CMAKE_POSITION_INDEPENDENT_CODE ${position_independent})
    unset(CMAKE_UNITY_BUILD)
    get_directory_property(Kokkos_VERSION DIRECTORY "${CAYSPIN_KOKKOS_SOURCE}" DEFINITION
                                                    Kokkos_VERSION)
    set(CAYSPIN_KOKKOS_ORIGIN "built from ${CAYSPIN_KOKKOS_SOURCE}")
  else()
    set(refused "")
    foreach(config version IN ZIP_LISTS Kokkos_CONSIDERED_CONFIGS Kokkos_CONSIDERED_VERSIONS)
      string(APPEND refused "\nNot accepted: version ${version} at ${config}")
    endforeach()
    message(
      FATAL_ERROR
        "cayspin needs Kokkos ${CAYSPIN_KOKKOS_MINIMUM} or newer. Give it in one of three ways:\n"
        "  1. define the target Kokkos::kokkos in the project that adds cayspin\n"
        "  2. name an installed Kokkos: -DCMAKE_PREFIX_PATH=DIR\n"
        "  3. name a Kokkos source tree to build: -DCAYSPIN_KOKKOS_SOURCE=DIR\n"
        "or run: bash cmake/bootstrap.sh build${refused}")
  endif()
endif()

if(Kokkos_VERSION AND (Kokkos_VERSION VERSION_LESS CAYSPIN_KOKKOS_MINIMUM
                       OR Kokkos_VERSION VERSION_GREATER_EQUAL CAYSPIN_KOKKOS_BEYOND))
  message(
    FATAL_ERROR
      "cayspin needs Kokkos ${CAYSPIN_KOKKOS_MINIMUM} or newer, below ${CAYSPIN_KOKKOS_BEYOND}; "
      "this is ${Kokkos_VERSION}: ${CAYSPIN_KOKKOS_ORIGIN}")
endif()

set(CAYSPIN_KOKKOS_VERSION "${Kokkos_VERSION}")
set(CAYSPIN_KOKKOS_BACKENDS "")
foreach(backend SERIAL OPENMP THREADS CUDA HIP SYCL)
  if(Kokkos_ENABLE_${backend})
    list(APPEND CAYSPIN_KOKKOS_BACKENDS ${backend})
  endif()
endforeach()
