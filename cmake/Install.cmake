# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Installs headers, the program and the package for find_package(cayspin).
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cayspin)

install(DIRECTORY include/cayspin ${PROJECT_BINARY_DIR}/include/cayspin paper/include/cayspin_paper
        DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp")

install(FILES LICENSE CITATION.cff DESTINATION ${CMAKE_INSTALL_DOCDIR})

install(TARGETS cayspin cayspin_same_bits cayspin_paper EXPORT cayspinTargets)
install(EXPORT cayspinTargets NAMESPACE cayspin:: DESTINATION ${package_dir})
if(TARGET cayspin_program)
  install(TARGETS cayspin_program cayspin_reproduce RUNTIME)
  include(cmake/InstallScripts.cmake)
  cayspin_install_scripts(.)
  install(FILES src/program/completion/cayspin.bash RENAME cayspin
          DESTINATION ${CMAKE_INSTALL_DATADIR}/bash-completion/completions)
  install(FILES src/program/completion/_cayspin
          DESTINATION ${CMAKE_INSTALL_DATADIR}/zsh/site-functions)
  include(cmake/ManPages.cmake)
endif()

if(Kokkos_DIR)
  set(CAYSPIN_KOKKOS_HINT "${Kokkos_DIR}")
elseif(IS_ABSOLUTE "${CMAKE_INSTALL_LIBDIR}")
  set(CAYSPIN_KOKKOS_HINT "${CMAKE_INSTALL_LIBDIR}/cmake/Kokkos")
else()
  set(CAYSPIN_KOKKOS_HINT "\${PACKAGE_PREFIX_DIR}/${CMAKE_INSTALL_LIBDIR}/cmake/Kokkos")
endif()
configure_package_config_file(cmake/cayspinConfig.cmake.in cayspinConfig.cmake
                              INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(cayspinConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/cayspinConfig.cmake
              ${PROJECT_BINARY_DIR}/cayspinConfigVersion.cmake cmake/cayspinOptimisation.cmake
              cmake/cayspinCudaToolkit.cmake cmake/cayspinFftw.cmake DESTINATION ${package_dir})

include(${CMAKE_CURRENT_LIST_DIR}/PkgConfig.cmake)
# Flags that a program needs to be compiled and linked with cayspin.
set(definitions $<TARGET_PROPERTY:cayspin,INTERFACE_COMPILE_DEFINITIONS>)
set(folders "-I\${prefix}/include/kokkos") # of a Kokkos that is installed with cayspin
if(Kokkos_DIR)
  set(folders $<TARGET_PROPERTY:Kokkos::kokkos,INTERFACE_INCLUDE_DIRECTORIES>)
  set(folders $<REMOVE_DUPLICATES:$<FILTER:${folders},EXCLUDE,^/usr/include$>>)
  set(folders "-I$<JOIN:${folders}, -I>")
endif()
set(flags "${CMAKE_CXX20_STANDARD_COMPILE_OPTION} ${folders}")
string(APPEND flags " $<$<BOOL:${definitions}>:-D$<JOIN:${definitions}, -D>>")
set(link_flags "")
cayspin_link_flags(cayspin link_flags)
foreach(target cayspin cayspin_same_bits)
  set(options $<TARGET_PROPERTY:${target},INTERFACE_COMPILE_OPTIONS>)
  cayspin_install_pkg_config(${target} "${PROJECT_DESCRIPTION}" "${flags} $<JOIN:${options}, >"
                             "${link_flags}")
endforeach()
