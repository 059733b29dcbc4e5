# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Checks that PROGRAM prints equal lines on 1, 2 and 4 ranks.
set(ENV{OMP_NUM_THREADS} 1)
foreach(ranks 1 2 4)
  execute_process(COMMAND ${MPIEXEC} ${NUMPROC} ${ranks} ${PROGRAM} OUTPUT_VARIABLE output
                  ERROR_VARIABLE errors RESULT_VARIABLE status)
  if(NOT status EQUAL 0 OR NOT output MATCHES "^energy [-.0-9]+, mean m [-. 0-9e]+\n$")
    message(FATAL_ERROR "${ranks} ranks: status ${status}\n${output}${errors}")
  endif()
  if(DEFINED first AND NOT output STREQUAL first)
    message(FATAL_ERROR "1 rank: ${first}${ranks} ranks: ${output}")
  endif()
  set(first "${output}")
endforeach()
message(STATUS "${first}")
