# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Installs the scripts of `plot` and `view` where the program looks for them: share/cayspin/python
# next to bin.
function(cayspin_install_scripts prefix)
  set(folder ${prefix}/share/cayspin/python)
  set(python ${PROJECT_SOURCE_DIR}/python)
  install(FILES ${python}/plot_texture.py ${python}/view_texture.py DESTINATION ${folder} ${ARGN})
  install(DIRECTORY ${python}/cayspin_plots DESTINATION ${folder} ${ARGN} PATTERN __pycache__
                                                                                  EXCLUDE)
  install(FILES ${python}/cayspin/command_line.py ${python}/cayspin/processes.py
          DESTINATION ${folder}/cayspin ${ARGN})
  install(DIRECTORY ${python}/cayspin/texture ${python}/cayspin/view DESTINATION ${folder}/cayspin
          ${ARGN} PATTERN __pycache__ EXCLUDE)
endfunction()
