# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# cayspin_add_test(<name> SOURCES <file>... [LIBRARIES <target>...] [LABELS <label>...]
#                  [THREADS <count>...] [TIMEOUT <seconds>] [BATCH <files>] [FAST]
#                  [ON_HOST_DEVICE])
# Adds a GoogleTest program test_<name> that links cayspin and tests/main.cpp, which runs the tests
# inside Kokkos. THREADS: registers one test per count if a threaded host backend is compiled in,
# otherwise one test with two threads, as without THREADS. BATCH: compiles that many files as one,
# so that headers they share are compiled once. FAST: optimises the program more. ON_HOST_DEVICE:
# adds a second program, test_<name>_on_host_device.
function(cayspin_add_test name)
  cmake_parse_arguments(PARSE_ARGV 1 arg "FAST;ON_HOST_DEVICE" "BATCH;TIMEOUT"
                        "SOURCES;LIBRARIES;LABELS;THREADS")
  if(arg_UNPARSED_ARGUMENTS OR NOT arg_SOURCES)
    message(FATAL_ERROR "cayspin_add_test(${name}): wrong arguments: ${arg_UNPARSED_ARGUMENTS}")
  endif()
  if(NOT arg_TIMEOUT)
    set(arg_TIMEOUT ${CAYSPIN_TIMEOUT})
  endif()

  add_executable(test_${name} ${arg_SOURCES})
  set(main cayspin_test_main)
  set(options ${CAYSPIN_TEST_OPTIONS})
  if(arg_FAST)
    set(main cayspin_fast_test_main)
    set(options ${CAYSPIN_FAST_TEST_OPTIONS})
  endif()
  target_link_libraries(test_${name} PRIVATE ${main} ${arg_LIBRARIES})
  target_compile_options(test_${name} PRIVATE ${options})
  target_precompile_headers(test_${name} REUSE_FROM ${main})
  if(arg_BATCH)
    set_target_properties(test_${name} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE
                                                                 ${arg_BATCH})
  endif()

  if(arg_THREADS AND (Kokkos_ENABLE_OPENMP OR Kokkos_ENABLE_THREADS))
    foreach(count IN LISTS arg_THREADS)
      cayspin_register_test(${name}_threads_${count} test_${name} ${count})
    endforeach()
  else()
    cayspin_register_test(${name} test_${name} 2)
  endif()
  if(arg_ON_HOST_DEVICE)
    cayspin_add_host_device_test(${name}_on_host_device SOURCES ${arg_SOURCES} LIBRARIES
                                 ${arg_LIBRARIES})
  endif()
endfunction()

# cayspin_add_host_device_test(<name> SOURCES <file>... [LIBRARIES <target>...])
# Adds a program test_<name> whose default space is the device of tests/host_device; adds none if
# there is no such device, or if it is the default of all programs.
function(cayspin_add_host_device_test name)
  if(NOT TARGET cayspin_host_device_test_main)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 arg "" "" "SOURCES;LIBRARIES")
  add_executable(test_${name} ${arg_SOURCES})
  target_link_libraries(test_${name} PRIVATE cayspin_host_device_test_main ${arg_LIBRARIES})
  target_compile_options(test_${name} PRIVATE ${CAYSPIN_TEST_OPTIONS})
  target_precompile_headers(test_${name} REUSE_FROM cayspin_host_device_test_main)
  set(arg_LABELS host_device)
  set(arg_TIMEOUT ${CAYSPIN_TIMEOUT})
  cayspin_register_test(${name} test_${name} 2)
endfunction()

macro(cayspin_register_test entry program threads)
  add_test(NAME ${entry} COMMAND ${program})
  # With the policy "active", waiting threads would slow down tests that run at the same time.
  set(environment OMP_NUM_THREADS=${threads} KOKKOS_NUM_THREADS=${threads} OMP_PROC_BIND=false
                  OMP_WAIT_POLICY=passive)
  set_tests_properties(${entry} PROPERTIES LABELS "${arg_LABELS}" TIMEOUT ${arg_TIMEOUT} PROCESSORS
                                           ${threads})
  set_tests_properties(${entry} PROPERTIES ENVIRONMENT "${environment}")
endmacro()
