# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# CAYSPIN_PYTHON: the interpreter of the tests that read trajectories or draw.
# An interpreter put in front of the system's may lack its packages.
function(can_draw result candidate)
  execute_process(COMMAND ${candidate} -c "import h5py, matplotlib" RESULT_VARIABLE status
                  OUTPUT_QUIET ERROR_QUIET)
  if(NOT status EQUAL 0)
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()
find_program(CAYSPIN_PYTHON NAMES python3 PATHS /usr/bin VALIDATOR can_draw
             DOC "Python with h5py and matplotlib")
if(NOT CAYSPIN_PYTHON)
  message(
    FATAL_ERROR
      "The tests draw pictures, and there is no python3 with h5py and matplotlib. "
      "Install them (Debian: python3-h5py, python3-matplotlib), name an "
      "interpreter with -DCAYSPIN_PYTHON=FILE, or build no tests: " "-DCAYSPIN_BUILD_TESTS=OFF.")
endif()
