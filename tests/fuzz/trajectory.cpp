// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Fuzzes trajectory files. Each file is read in a child process first, so that faults of HDF5 stay
// there.
#include "io/trajectory.hpp"

#include "../support/reads_in_child.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t bytes) {
  auto const path = cayspin::fuzz::file_with(data, bytes, ".h5");
  cayspin::fuzz::refuse_or_read([&] {
    auto const info = cayspin::io::read_info(path);
    if (info.frames > 0) cayspin::io::read_spins(path, info.header.shape);
  });
  return 0;
}
