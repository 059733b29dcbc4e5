# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Installs into a clean prefix, builds the projects SOURCES against it, and runs their tests.
# Configures the first project again, to check the warning about a build without optimisation.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${CAYSPIN_BUILD} --prefix ${WORK}/prefix)
foreach(source IN LISTS SOURCES)
  cmake_path(GET source FILENAME name)
  configure_and_build(${source} ${WORK}/${name} -DCMAKE_PREFIX_PATH=${WORK}/prefix)
  run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/${name} --output-on-failure --no-tests=error -LE
      validation)
endforeach()
list(GET SOURCES 0 source)
warns_without_optimisation(${source} ${WORK}/no_build_type -DCMAKE_PREFIX_PATH=${WORK}/prefix)
