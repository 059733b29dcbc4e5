# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
add_library(Kokkos::kokkos INTERFACE IMPORTED)
