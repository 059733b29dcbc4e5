# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Settings for a build by pip. The loader looks for libraries in glibc-hwcaps/LEVEL first, so a
# wheel can have libraries for several levels: cmake/PortableWheel.cmake.
set(CAYSPIN_PROCESSOR native CACHE STRING "The processor for which a wheel is compiled")
set(processors native x86-64 x86-64-v3 x86-64-v4 any-x86-64)
if(NOT CAYSPIN_PROCESSOR IN_LIST processors)
  list(JOIN processors ", " processors)
  message(FATAL_ERROR "CAYSPIN_PROCESSOR is ${CAYSPIN_PROCESSOR}; accepted: ${processors}")
endif()

# pip does not install these libraries, so one message names all that are missing.
enable_language(C) # FindHDF5 compiles a C program
set(debian_of_HDF5 libhdf5-dev)
set(debian_of_fmt libfmt-dev)
set(debian_of_muparser libmuparser-dev)
set(debian_of_tomlplusplus libtomlplusplus-dev)
set(debian_of_Eigen3 libeigen3-dev)
set(debian_of_CLI11 libcli11-dev)
set(debian_of_nlohmann_json nlohmann-json3-dev)
set(missing "")
foreach(package HDF5 fmt muparser tomlplusplus Eigen3 CLI11 nlohmann_json)
  find_package(${package} QUIET)
  if(NOT ${package}_FOUND)
    string(APPEND missing " ${debian_of_${package}}")
  endif()
endforeach()
if(missing)
  message(FATAL_ERROR "cayspin needs packages that are not installed: apt-get install${missing}")
endif()
