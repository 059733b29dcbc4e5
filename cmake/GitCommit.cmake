# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Target cayspin_git_commit: <cayspin_git_commit.hpp> defines CAYSPIN_GIT_COMMIT, the full commit
# followed by "-dirty" when tracked files differ from it, or "unknown" outside cayspin's repository.
# The commit is looked up at every build, but the header is written only if the commit has changed.
# The look-up runs this file as a script (cmake -P).
if(CMAKE_SCRIPT_MODE_FILE)
  cmake_policy(VERSION 3.25)
  set(commit "")
  if(GIT_EXECUTABLE)
    # The prefix is the path to SOURCE_DIR within its repository. If it is not empty, the repository
    # is that of another project, which contains a copy of cayspin.
    execute_process(
      COMMAND ${GIT_EXECUTABLE} rev-parse --show-prefix
      WORKING_DIRECTORY ${SOURCE_DIR}
      RESULT_VARIABLE status
      OUTPUT_VARIABLE prefix
      OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
    if(status EQUAL 0 AND "${prefix}" STREQUAL "")
      execute_process(
        COMMAND ${GIT_EXECUTABLE} describe --always --dirty --abbrev=40 --exclude=*
        WORKING_DIRECTORY ${SOURCE_DIR} OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
                                                               ERROR_QUIET)
    endif()
  endif()
  if(NOT commit)
    set(commit unknown)
  endif()
  file(CONFIGURE OUTPUT ${HEADER} CONTENT "#pragma once\n#define CAYSPIN_GIT_COMMIT \"@commit@\"\n"
       @ONLY)
  return()
endif()

find_package(Git QUIET)
set(header ${PROJECT_BINARY_DIR}/generated/cayspin_git_commit.hpp)
add_custom_target(
  cayspin_look_up_git_commit
  COMMAND ${CMAKE_COMMAND} -DGIT_EXECUTABLE=${GIT_EXECUTABLE} -DSOURCE_DIR=${PROJECT_SOURCE_DIR}
          -DHEADER=${header} -P ${CMAKE_CURRENT_LIST_FILE}
  BYPRODUCTS ${header}
  COMMENT "Looking up the git commit"
  VERBATIM)
add_library(cayspin_git_commit INTERFACE)
target_include_directories(cayspin_git_commit INTERFACE ${PROJECT_BINARY_DIR}/generated)
add_dependencies(cayspin_git_commit cayspin_look_up_git_commit)
