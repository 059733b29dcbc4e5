# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# run(<command>...) runs a command, and stops the script if it fails.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# configure_and_build(<source> <build> <option>...)
function(configure_and_build source build)
  run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${source} -B ${build} -DCMAKE_CXX_COMPILER=${COMPILER}
      -DCMAKE_BUILD_TYPE=${BUILD_TYPE} -DCMAKE_CXX_FLAGS=${FLAGS} ${ARGN})
  run(${CMAKE_COMMAND} --build ${build})
endfunction()

# configure_warns(<TRUE|FALSE> <source> <build> <option>...) configures with these options, and
# stops the script unless there is a warning about optimisation (TRUE) or none (FALSE).
function(configure_warns expected source build)
  execute_process(
    COMMAND ${CMAKE_COMMAND} --fresh -G ${GENERATOR} -S ${source} -B ${build}
            -DCMAKE_CXX_COMPILER=${COMPILER} ${ARGN} OUTPUT_VARIABLE output
    ERROR_VARIABLE output COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
  string(REGEX REPLACE "[ \n]+" " " output "${output}")
  if(output MATCHES "cayspin is compiled without optimisation.*-DCMAKE_BUILD_TYPE=Release")
    set(found TRUE)
  else()
    set(found FALSE)
  endif()
  if(NOT found STREQUAL expected)
    message(FATAL_ERROR "Warning about optimisation: ${found}, not ${expected}:\n${output}")
  endif()
endfunction()

# warns_without_optimisation(<source> <build> <option>...): checks that there is a warning without a
# build type, and none with a build type or with -O2.
function(warns_without_optimisation)
  unset(ENV{CXXFLAGS})
  configure_warns(TRUE ${ARGN})
  configure_warns(FALSE ${ARGN} -DCMAKE_BUILD_TYPE=Release)
  configure_warns(FALSE ${ARGN} -DCMAKE_BUILD_TYPE=Debug)
  configure_warns(FALSE ${ARGN} -DCMAKE_CXX_FLAGS=-O2)
endfunction()
