# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# Installs into a clean prefix, builds the examples against it and runs them.
include(${CMAKE_CURRENT_LIST_DIR}/run.cmake)
file(REMOVE_RECURSE ${WORK})
run(${CMAKE_COMMAND} --install ${CAYSPIN_BUILD} --prefix ${WORK}/prefix)
configure_and_build(${EXAMPLES} ${WORK}/build -DCMAKE_PREFIX_PATH=${WORK}/prefix)
run(${CMAKE_CTEST_COMMAND} --test-dir ${WORK}/build --output-on-failure --no-tests=error)
