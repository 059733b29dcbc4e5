# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Makes files for pkg-config, for build systems other than CMake. Kokkos has no such file, so ours
# include the flags of the Kokkos that cayspin was built with.
include(${CMAKE_CURRENT_LIST_DIR}/cayspinCudaToolkit.cmake)

# Adds to the list `flags` the libraries that a target links with, and the libraries that these link
# with, in the order for the linker.
function(cayspin_link_flags target flags)
  # A Kokkos that is built within this project finds these packages only for itself, so they are
  # looked for here again.
  if(NOT TARGET ${target} AND target MATCHES "^CUDA::")
    cayspin_find_with_cuda(CUDAToolkit QUIET)
  elseif(NOT TARGET ${target} AND target MATCHES "^(OpenMP|Threads)::")
    find_package(${CMAKE_MATCH_1} QUIET)
  endif()
  if(NOT TARGET ${target})
    if(target MATCHES "^cayspin_") # defined later, with only headers
      return()
    endif()
    if(target MATCHES "^[A-Za-z0-9_.+]+$")
      set(target -l${target})
    endif()
    set(${flags} ${${flags}} ${target} PARENT_SCOPE)
    return()
  endif()
  get_target_property(aliased ${target} ALIASED_TARGET)
  if(aliased)
    set(target ${aliased})
  endif()
  get_target_property(type ${target} TYPE)
  get_target_property(imported ${target} IMPORTED)
  if(NOT type STREQUAL INTERFACE_LIBRARY)
    if(imported)
      list(APPEND ${flags} $<TARGET_FILE:${target}>)
    else()
      list(APPEND ${flags} \${libdir}/$<TARGET_FILE_NAME:${target}>)
    endif()
  endif()
  get_target_property(libraries ${target} INTERFACE_LINK_LIBRARIES)
  if(libraries)
    foreach(library IN LISTS libraries)
      string(REGEX REPLACE "^\\$<(LINK_ONLY|INSTALL_INTERFACE):(.*)>$" "\\2" library "${library}")
      if(NOT library MATCHES "^\\$<|^::@")
        cayspin_link_flags(${library} ${flags})
      endif()
    endforeach()
  endif()
  get_target_property(options ${target} INTERFACE_LINK_OPTIONS)
  if(options)
    list(APPEND ${flags} ${options})
  endif()
  list(REVERSE ${flags}) # if a library is listed twice, only the last place is kept
  list(REMOVE_DUPLICATES ${flags})
  list(REVERSE ${flags})
  set(${flags} ${${flags}} PARENT_SCOPE)
endfunction()

# Sets `result` to an installation folder in the form of a pkg-config file. CMAKE_INSTALL_LIBDIR and
# the like may be absolute.
function(cayspin_pkg_config_folder result folder)
  if(NOT IS_ABSOLUTE "${folder}")
    set(folder "\${prefix}/${folder}")
  endif()
  set(${result} "${folder}" PARENT_SCOPE)
endfunction()

# cayspin_install_pkg_config(<name> <description> <compile flags> <link flags>)
function(cayspin_install_pkg_config name description compile_flags link_flags)
  # Flags depend on the language: CMake writes a file for each language, and the file for C++ is
  # installed.
  string(REPLACE "$<LINK_LANGUAGE:" "$<COMPILE_LANGUAGE:" link_flags "${link_flags}")
  file(RELATIVE_PATH to_prefix ${CMAKE_INSTALL_FULL_LIBDIR}/pkgconfig ${CMAKE_INSTALL_PREFIX})
  string(REGEX REPLACE "/$" "" to_prefix "${to_prefix}")
  cayspin_pkg_config_folder(includedir "${CMAKE_INSTALL_INCLUDEDIR}")
  cayspin_pkg_config_folder(libdir "${CMAKE_INSTALL_LIBDIR}")
  file(
    GENERATE
    OUTPUT ${PROJECT_BINARY_DIR}/$<COMPILE_LANGUAGE>/${name}.pc
    CONTENT
      "prefix=\${pcfiledir}/${to_prefix}
includedir=${includedir}
libdir=${libdir}
cxx=${CMAKE_CXX_COMPILER}
backends=${CAYSPIN_KOKKOS_BACKENDS}

Name: ${name}
Description: ${description}
Version: ${PROJECT_VERSION}
Cflags: -I\${includedir} ${compile_flags}
Libs: $<JOIN:${link_flags}, >
")
  install(FILES ${PROJECT_BINARY_DIR}/CXX/${name}.pc DESTINATION ${CMAKE_INSTALL_LIBDIR}/pkgconfig)
endfunction()
