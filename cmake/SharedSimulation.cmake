# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# CAYSPIN_SHARED_SIMULATION: the simulation is one shared library, which the programs, the C
# interface and the Python module link. Otherwise each of them contains a copy.
# CAYSPIN_KOKKOS_IN_SHARED_LIBRARIES: Kokkos can be linked into shared libraries.

# A Kokkos that is built together with cayspin is position-independent if cayspin requests that.
set(CAYSPIN_KOKKOS_IN_SHARED_LIBRARIES ON)
if(Kokkos_FOUND)
  set(probe ${PROJECT_BINARY_DIR}/probe/shared_with_kokkos.cpp)
  file(WRITE ${probe} "#include <Kokkos_Core.hpp>\nvoid probe() { Kokkos::initialize(); }\n")
  try_compile(
    CAYSPIN_KOKKOS_LINKS_INTO_SHARED ${PROJECT_BINARY_DIR}/probe
    SOURCES ${probe}
    COMPILE_DEFINITIONS -fPIC
    LINK_OPTIONS -shared
    LINK_LIBRARIES Kokkos::kokkos CXX_STANDARD 20)
  set(CAYSPIN_KOKKOS_IN_SHARED_LIBRARIES ${CAYSPIN_KOKKOS_LINKS_INTO_SHARED})
endif()

set(reason "")
if(DEFINED BUILD_SHARED_LIBS AND NOT BUILD_SHARED_LIBS)
  set(reason "BUILD_SHARED_LIBS is OFF")
elseif(NOT CMAKE_SYSTEM_NAME STREQUAL Linux)
  set(reason "this is not Linux")
elseif(Kokkos_ENABLE_CUDA OR Kokkos_ENABLE_HIP OR Kokkos_ENABLE_SYCL)
  set(reason "Kokkos compiles for a GPU")
elseif(CAYSPIN_CHECKED OR CAYSPIN_HOST_DEVICE)
  set(reason "this build is for tests")
elseif(NOT Kokkos_FOUND AND CAYSPIN_KOKKOS_ORIGIN STREQUAL "the parent project's")
  set(reason "the parent project builds Kokkos")
elseif(NOT CAYSPIN_KOKKOS_IN_SHARED_LIBRARIES)
  set(reason "${Kokkos_DIR} was built without CMAKE_POSITION_INDEPENDENT_CODE")
endif()
if(reason)
  set(CAYSPIN_SHARED_SIMULATION OFF)
  message(STATUS "no shared library of the simulation, but a copy in each program: ${reason}")
  return()
endif()
set(CAYSPIN_SHARED_SIMULATION ON)

# Programs and libraries find the shared library by a path relative to themselves, so folders may be
# moved.
set(CMAKE_BUILD_RPATH_USE_ORIGIN ON)
file(RELATIVE_PATH to_libraries ${CMAKE_INSTALL_FULL_BINDIR} ${CMAKE_INSTALL_FULL_LIBDIR})
if(SKBUILD) # cayspin/ has the libraries, cayspin/bin the program
  set(to_libraries ..)
endif()
list(APPEND CMAKE_INSTALL_RPATH $ORIGIN $ORIGIN/${to_libraries})
