// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Fuzzes the files of sweeps. Each file is read in a child process first.
#include "io/sweep.hpp"

#include "../support/reads_in_child.hpp"
#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t bytes) {
  auto const path = cayspin::fuzz::file_with(data, bytes, ".h5");
  cayspin::fuzz::refuse_or_read([&] { cayspin::io::read_sweep(path); });
  return 0;
}
