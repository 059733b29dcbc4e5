# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Any version: like Kokkos, it claims compatibility with everything older.
set(PACKAGE_VERSION ${NO_KOKKOS_VERSION})
if(PACKAGE_VERSION VERSION_GREATER_EQUAL PACKAGE_FIND_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
endif()
