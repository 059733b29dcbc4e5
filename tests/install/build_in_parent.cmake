# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# A parent project has its own Kokkos::kokkos and adds cayspin as a folder; without a build type it
# gets a warning.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
set(options -DKokkos_DIR=${Kokkos_DIR} -DCAYSPIN_SOURCE=${CAYSPIN_SOURCE})
configure_and_build(${PARENT} ${WORK} ${options})
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK} --output-on-failure --no-tests=error)
warns_without_optimisation(${PARENT} ${WORK}/no_build_type ${options})
