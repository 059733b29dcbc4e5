# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# cmake -DPROGRAM=... -P same_bits.cmake: checks that fields are bitwise identical with 1, 2, 3 and
# 5 threads.
foreach(threads 1 2 3 5)
  set(ENV{OMP_NUM_THREADS} ${threads})
  set(ENV{OMP_PROC_BIND} false)
  execute_process(COMMAND ${PROGRAM} --gtest_filter=*HaveBitsToCompare OUTPUT_VARIABLE output
                  ERROR_VARIABLE ignored COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX MATCHALL "bits [0-9a-f]+" bits "${output}")
  list(LENGTH bits count)
  if(NOT count EQUAL 4)
    message(FATAL_ERROR "${count} lines of bits on ${threads} threads")
  elseif(NOT DEFINED first)
    set(first "${bits}")
  elseif(NOT bits STREQUAL first)
    message(FATAL_ERROR "${threads} threads: ${bits}, one thread: ${first}")
  endif()
endforeach()
