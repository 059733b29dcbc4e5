// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Fuzzes OVF files in all their formats.
#include "io/ovf.hpp"

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t bytes) {
  auto const path = cayspin::fuzz::file_with(data, bytes, ".ovf");
  cayspin::fuzz::refuse_or_read([&] { cayspin::io::read_ovf(path); });
  return 0;
}
