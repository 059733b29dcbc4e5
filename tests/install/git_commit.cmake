# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# The header with the git commit names the commit of cayspin's repository, but not that of another
# project's repository which contains a copy of cayspin.
cmake_minimum_required(VERSION 3.25)
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK}/repository/cayspin)
set(git ${GIT_EXECUTABLE} -C ${WORK}/repository -c user.name=Test -c user.email=test@example.org -c
        commit.gpgsign=false)
run(${git} init --quiet)
run(${git} commit --quiet --allow-empty --message First)

function(expect_commit folder pattern)
  run(${CMAKE_COMMAND} -DGIT_EXECUTABLE=${GIT_EXECUTABLE} -DSOURCE_DIR=${folder}
      -DHEADER=${WORK}/commit.hpp -P ${SCRIPT})
  file(READ ${WORK}/commit.hpp header)
  if(NOT header MATCHES "COMMIT \"${pattern}\"")
    message(FATAL_ERROR "In ${folder}: ${header}")
  endif()
endfunction()
expect_commit(${WORK}/repository "[0-9a-f]+")
expect_commit(${WORK}/repository/cayspin unknown)
