# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Makes a copy of cayspin that has another version in its namespace, and in which sites() returns
# the negative number of sites. Builds a program that uses both versions.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(COPY ${CAYSPIN_SOURCE}/include DESTINATION ${WORK}/other)
file(GLOB_RECURSE headers ${WORK}/other/include/*.hpp)
foreach(header IN LISTS headers)
  file(READ ${header} text)
  string(REGEX REPLACE "namespace cayspin::inline v[0-9_]+" "namespace cayspin::inline v0_0" text
                       "${text}")
  string(REPLACE "sites() const { return own(0) *" "sites() const { return -own(0) *" text
                 "${text}")
  file(WRITE ${header} "${text}")
endforeach()
configure_and_build(
  ${TWO_VERSIONS} ${WORK}/build -DKokkos_DIR=${Kokkos_DIR} -DCAYSPIN_SOURCE=${CAYSPIN_SOURCE}
  -DOTHER_VERSION=${WORK}/other/include -DCMAKE_CXX_FLAGS_RELEASE=-O0)
run(${WORK}/build/two_versions)
