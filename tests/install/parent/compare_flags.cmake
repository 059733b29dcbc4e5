# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# To the flags of Kokkos, cayspin::cayspin adds only include folders, and cayspin::same_bits also
# -ffp-contract=off.
file(READ ${COMMANDS} entries)

# flags_of(<result> <target>): flags of the target's compile command, without folders and file names
function(flags_of result target)
  string(JSON count LENGTH "${entries}")
  math(EXPR last "${count} - 1")
  foreach(i RANGE ${last})
    string(JSON command GET "${entries}" ${i} command)
    if(command MATCHES "/${target}\\.dir/")
      string(REGEX REPLACE " -o .*" "" command "${command}")
      string(REGEX REPLACE " (-I|-isystem )[^ ]+" "" command "${command}")
      set(${result} "${command}" PARENT_SCOPE)
    endif()
  endforeach()
endfunction()
flags_of(by_kokkos by_Kokkos_kokkos)
flags_of(by_cayspin by_cayspin_cayspin)
flags_of(by_same_bits by_cayspin_same_bits)
if(NOT by_kokkos OR NOT by_cayspin STREQUAL by_kokkos)
  message(FATAL_ERROR "By Kokkos:\n${by_kokkos}\nby cayspin::cayspin:\n${by_cayspin}")
endif()
string(REPLACE " -ffp-contract=off" "" less "${by_same_bits}")
if(less STREQUAL by_same_bits OR NOT less STREQUAL by_kokkos)
  message(FATAL_ERROR "By Kokkos:\n${by_kokkos}\nby cayspin::same_bits:\n${by_same_bits}")
endif()
