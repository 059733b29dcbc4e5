# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# A Kokkos of any version: like the real one, it claims to be compatible with every older version.
set(PACKAGE_VERSION ${NO_KOKKOS_VERSION})
if(PACKAGE_VERSION VERSION_GREATER_EQUAL PACKAGE_FIND_VERSION)
  set(PACKAGE_VERSION_COMPATIBLE TRUE)
endif()
