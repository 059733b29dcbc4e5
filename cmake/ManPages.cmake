# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Generates manual pages from --help if help2man is installed: man/cayspin.1 for the program and
# man/cayspin-COMMAND.1 for each command, in the build folder.
find_program(HELP2MAN help2man)
if(NOT HELP2MAN OR CMAKE_CROSSCOMPILING)
  message(STATUS "cayspin no manual pages: there is no help2man")
  return()
endif()
set(pages ${PROJECT_BINARY_DIR}/man)
add_custom_command(
  OUTPUT ${pages}/cayspin.1
  COMMAND bash ${CMAKE_CURRENT_LIST_DIR}/man_pages.sh ${HELP2MAN} $<TARGET_FILE:cayspin_program>
          ${pages}
  DEPENDS cayspin_program ${CMAKE_CURRENT_LIST_DIR}/man_pages.sh
  COMMENT "Manual pages"
  VERBATIM)
add_custom_target(cayspin_man ALL DEPENDS ${pages}/cayspin.1)
install(DIRECTORY ${pages}/ DESTINATION ${CMAKE_INSTALL_MANDIR}/man1 FILES_MATCHING PATTERN "*.1")
