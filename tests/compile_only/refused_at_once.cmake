# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Builds the target refused_at_once, which must fail with each of SENTENCES as an error, at least as
# often as the sentence is listed.
execute_process(
  COMMAND ${CMAKE_COMMAND} --build ${BUILD} --config ${CONFIG} --target refused_at_once
  RESULT_VARIABLE status OUTPUT_VARIABLE log ERROR_VARIABLE log)
if(status EQUAL 0)
  message(FATAL_ERROR "The mistakes compile.")
endif()
foreach(sentence IN LISTS SENTENCES)
  string(REGEX MATCHALL "error: [^\n]*${sentence}" errors "${log}")
  set(same ${SENTENCES})
  list(FILTER same INCLUDE REGEX "^${sentence}$")
  list(LENGTH errors found)
  list(LENGTH same expected)
  if(found LESS expected)
    message(SEND_ERROR "Errors that say so: ${found} of ${expected}: ${sentence}")
  endif()
endforeach()
