// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/reading_trial.hpp"
#include "program/read_in_child.hpp"

namespace cayspin::test {

/// Reads HDF5 files as the program does: in a child process, to which faults of HDF5 are confined.
inline bool const reads_in_child = [] {
  io::set_trial(program::try_in_child);
  return true;
}();

}  // namespace cayspin::test
