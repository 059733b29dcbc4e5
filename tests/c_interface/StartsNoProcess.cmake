# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# cmake -D CMAKE_NM=NM -P StartsNoProcess.cmake LIBRARY...: checks that no LIBRARY calls a function
# that starts a process or waits for one. There have to be at least three libraries.
set(calls
    fork
    vfork
    _Fork
    forkpty
    clone
    clone3
    popen
    system
    wait
    wait3
    wait4
    waitid
    waitpid)
list(APPEND calls execl execle execlp execv execve execvp execvpe fexecve posix_spawn posix_spawnp)
list(JOIN calls "|" calls)
math(EXPR last "${CMAKE_ARGC} - 1")
set(count 0)
foreach(number RANGE ${last})
  set(library "${CMAKE_ARGV${number}}")
  if(NOT library MATCHES "\\.(a|so)[^/]*$")
    continue()
  endif()
  set(which -u)
  if(library MATCHES "\\.so[^/]*$")
    list(APPEND which -D)
  endif()
  execute_process(COMMAND ${CMAKE_NM} ${which} ${library} OUTPUT_VARIABLE symbols
                  ERROR_QUIET COMMAND_ERROR_IS_FATAL ANY)
  if(NOT symbols MATCHES " U [a-zA-Z_]")
    message(FATAL_ERROR "${library}: no undefined symbols were found")
  endif()
  if(symbols MATCHES "[ \t](${calls})(@[A-Z_0-9.]+)?[\r\n]")
    message(FATAL_ERROR "${library} calls ${CMAKE_MATCH_1}")
  endif()
  math(EXPR count "${count} + 1")
endforeach()
if(count LESS 3)
  message(FATAL_ERROR "${count} libraries were given")
endif()
message(STATUS "${count} libraries start no process")
