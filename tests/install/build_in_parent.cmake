# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# A parent project brings its own Kokkos::kokkos and adds cayspin as a folder.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
configure_and_build(${PARENT} ${WORK} -DKokkos_DIR=${Kokkos_DIR} -DCAYSPIN_SOURCE=${CAYSPIN_SOURCE})
run(${WORK}/parent)
