# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# cmake -DVALGRIND=... -DPROGRAM=... -DEXPECTED=... [-DRECORD=ON] -P compare.cmake
# Runs the program under callgrind and compares each count of instructions per site and step with
# the expected one; RECORD writes what is found into EXPECTED instead.
set(sites 1024)
set(margin_percent 2)

set(folder callgrind)
file(REMOVE_RECURSE ${folder})
file(MAKE_DIRECTORY ${folder})
execute_process(
  COMMAND ${VALGRIND} --tool=callgrind --collect-atstart=no --callgrind-out-file=${folder}/counts
          ${PROGRAM}
  RESULT_VARIABLE status
  ERROR_VARIABLE log)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "callgrind ended with ${status}:\n${log}")
endif()

# 3456 hundredths are 34.56
function(with_point hundredths result)
  math(EXPR whole "${hundredths} / 100")
  math(EXPR rest "${hundredths} % 100 + 100")
  string(SUBSTRING ${rest} 1 2 rest)
  set(${result} ${whole}.${rest} PARENT_SCOPE)
endfunction()

file(GLOB dumps ${folder}/counts.*)
set(lines "")
foreach(dump IN LISTS dumps)
  file(STRINGS ${dump} trigger REGEX "^desc: Trigger: Client Request: ")
  file(STRINGS ${dump} total REGEX "^totals: ")
  string(REGEX REPLACE ".*: " "" name "${trigger}")
  string(REGEX REPLACE ".*: " "" total "${total}")
  math(EXPR found_${name} "(${total} * 100 + ${sites} / 2) / ${sites}")
  with_point(${found_${name}} shown_${name})
  list(APPEND lines "${name} ${shown_${name}}")
endforeach()
list(SORT lines)

if(RECORD)
  list(JOIN lines "\n" text)
  file(WRITE ${EXPECTED} "${text}\n")
  message(STATUS "written to ${EXPECTED}:\n${text}")
  return()
endif()

set(wrong "")
set(names "")
file(STRINGS ${EXPECTED} expected_lines)
foreach(line IN LISTS expected_lines)
  string(REGEX MATCH "^([^ ]+) ([0-9]+)\\.([0-9][0-9])$" matched "${line}")
  set(name ${CMAKE_MATCH_1})
  math(EXPR expected "${CMAKE_MATCH_2} * 100 + ${CMAKE_MATCH_3}")
  list(APPEND names ${name})
  if(NOT DEFINED found_${name})
    list(APPEND wrong "${name}: not counted")
    continue()
  endif()
  message(STATUS "${name}: ${shown_${name}}, expected ${CMAKE_MATCH_2}.${CMAKE_MATCH_3}")
  math(EXPR difference "(${found_${name}} - ${expected}) * 100")
  math(EXPR margin "${expected} * ${margin_percent}")
  if(difference GREATER margin OR difference LESS -${margin})
    list(APPEND wrong "${name}: ${shown_${name}} instructions per site and step, \
expected ${CMAKE_MATCH_2}.${CMAKE_MATCH_3}")
  endif()
endforeach()
list(LENGTH names expected_count)
list(LENGTH lines found_count)
if(NOT expected_count EQUAL found_count)
  list(APPEND wrong "${found_count} kernels counted, ${expected_count} expected")
endif()
if(wrong)
  list(JOIN wrong "\n  " text)
  message(FATAL_ERROR "more than ${margin_percent} % away:\n  ${text}\n"
                      "Where that is meant, build the target record_instructions.")
endif()
