# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# CAYSPIN_PYTHON: an interpreter with h5py and matplotlib, for what tests draw and for the module in
# the build tree. One that is put in front of the system's may lack them.
function(can_draw result candidate)
  execute_process(COMMAND ${candidate} -c "import h5py, matplotlib" RESULT_VARIABLE status
                  OUTPUT_QUIET ERROR_QUIET)
  if(NOT status EQUAL 0)
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()
find_program(CAYSPIN_PYTHON NAMES python3 PATHS /usr/bin VALIDATOR can_draw
             DOC "Python with h5py and matplotlib")
