# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Of any version, as Kokkos' own: it takes itself for compatible with everything older.
set(PACKAGE_VERSION ${NO_KOKKOS_VERSION})
if(PACKAGE_VERSION VERSION_GREATER_EQUAL PACKAGE_FIND_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
endif()
