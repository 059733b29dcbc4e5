# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# For a wheel for any x86-64, builds its libraries once more for AVX2 and for AVX-512. The loader of
# glibc 2.33 or newer takes those of the highest level that the processor has.
include(ExternalProject)
set(passed "")
foreach(name CMAKE_BUILD_TYPE CAYSPIN_KOKKOS_SOURCE HDF5_ROOT HDF5_USE_STATIC_LIBRARIES)
  list(APPEND passed "-D${name}=${${name}}")
endforeach()
foreach(processor x86-64-v3 x86-64-v4)
  set(tree ${PROJECT_BINARY_DIR}/${processor})
  ExternalProject_Add(
    cayspin_${processor}
    SOURCE_DIR ${PROJECT_SOURCE_DIR}
    BINARY_DIR ${tree}
    CMAKE_ARGS ${passed} -DSKBUILD=ON -DCAYSPIN_PROCESSOR=${processor} -DCAYSPIN_BUILD_TESTS=OFF
               -DCAYSPIN_BUILD_BENCH=OFF -DCAYSPIN_BUILD_EXAMPLES=OFF -DCAYSPIN_INSTALL=OFF
               -DCMAKE_BUILD_WITH_INSTALL_RPATH=ON -DCMAKE_SHARED_LINKER_FLAGS=-s
    BUILD_COMMAND ${CMAKE_COMMAND} --build ${tree} --target cayspin_program_code
    INSTALL_COMMAND ""
    BUILD_ALWAYS ON
    USES_TERMINAL_BUILD ON)
  add_dependencies(cayspin_program cayspin_${processor})
  foreach(library simulation program_code)
    install(FILES ${tree}/lib/libcayspin_${library}.so DESTINATION cayspin/glibc-hwcaps/${processor}
            COMPONENT python)
  endforeach()
endforeach()

# The wheel contains the libraries of other projects, and therefore also their licences.
foreach(package libhdf5-dev libfmt-dev libmuparser-dev libtomlplusplus-dev libeigen3-dev
                libcli11-dev nlohmann-json3-dev libfftw3-dev libpng-dev zlib1g-dev libgomp1)
  set(copyright /usr/share/doc/${package}/copyright)
  if(EXISTS ${copyright})
    install(FILES ${copyright} DESTINATION cayspin/licenses RENAME ${package}.txt COMPONENT python)
  endif()
endforeach()
install(FILES ${CAYSPIN_KOKKOS_SOURCE}/LICENSE DESTINATION cayspin/licenses RENAME kokkos.txt
        COMPONENT python)
