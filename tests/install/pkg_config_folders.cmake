# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Files for pkg-config name the installation folders, which may be relative to the prefix or
# absolute.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)

# expect_folders(<line> <line> <option>...): configures with these options.
function(expect_folders includedir libdir)
  run(${CMAKE_COMMAND} --fresh -G ${GENERATOR} -S ${CMAKE_CURRENT_LIST_DIR}/pkg_config_folders -B
      ${WORK} -DCMAKE_CXX_COMPILER=${COMPILER} -DCAYSPIN_SOURCE=${CAYSPIN_SOURCE}
      -DCMAKE_INSTALL_PREFIX=/usr ${ARGN})
  file(STRINGS ${WORK}/CXX/folders.pc lines)
  foreach(line ${includedir} ${libdir})
    if(NOT line IN_LIST lines)
      message(FATAL_ERROR "There is no line ${line} in ${lines}")
    endif()
  endforeach()
endfunction()
expect_folders("includedir=\${prefix}/include" "libdir=\${prefix}/lib64"
               -DCMAKE_INSTALL_LIBDIR=lib64)
expect_folders("includedir=/dev-out/include" "libdir=/lib-out/lib"
               -DCMAKE_INSTALL_INCLUDEDIR=/dev-out/include -DCMAKE_INSTALL_LIBDIR=/lib-out/lib)
