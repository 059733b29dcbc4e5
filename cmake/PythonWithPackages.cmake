# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# cayspin_find_python(<variable> <modules> <doc>): finds an interpreter that imports the modules,
# such as "h5py, matplotlib". The first one on PATH may lack them. The modules may also be in
# .deps/site, which has the theme of the documentation's site.
function(imports_modules result candidate)
  execute_process(
    COMMAND ${CMAKE_COMMAND} -E env "PYTHONPATH=${PROJECT_SOURCE_DIR}/.deps/site:$ENV{PYTHONPATH}"
            ${candidate} -c "import ${modules}" RESULT_VARIABLE status OUTPUT_QUIET ERROR_QUIET)
  if(NOT status EQUAL 0)
    set(${result} FALSE PARENT_SCOPE)
  endif()
endfunction()
function(cayspin_find_python variable modules doc)
  find_program(${variable} NAMES python3 PATHS /usr/bin VALIDATOR imports_modules DOC "${doc}")
endfunction()

# For drawing tests and for the module in the build tree.
cayspin_find_python(CAYSPIN_PYTHON "h5py, matplotlib" "Python with h5py and matplotlib")
