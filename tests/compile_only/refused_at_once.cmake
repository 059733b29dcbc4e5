# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Builds the target refused_at_once, which fails with each of SENTENCES as an error.
execute_process(
  COMMAND ${CMAKE_COMMAND} --build ${BUILD} --config ${CONFIG} --target refused_at_once
  RESULT_VARIABLE status OUTPUT_VARIABLE log ERROR_VARIABLE log)
if(status EQUAL 0)
  message(FATAL_ERROR "The mistakes compile.")
endif()
foreach(sentence IN LISTS SENTENCES)
  if(NOT log MATCHES "error: [^\n]*${sentence}")
    message(SEND_ERROR "No error says: ${sentence}")
  endif()
endforeach()
