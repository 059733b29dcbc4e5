# SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
# CAYSPIN_PYTHON: the interpreter of the tests that read trajectories or draw.
include(${CMAKE_CURRENT_LIST_DIR}/PythonWithPackages.cmake)
if(NOT CAYSPIN_PYTHON)
  message(
    FATAL_ERROR
      "The tests draw pictures, and there is no python3 with h5py and matplotlib. "
      "Install them (Debian: python3-h5py, python3-matplotlib), name an "
      "interpreter with -DCAYSPIN_PYTHON=FILE, or build no tests: " "-DCAYSPIN_BUILD_TESTS=OFF.")
endif()
