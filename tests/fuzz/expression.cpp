// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Fuzzes formulas: each is compiled and evaluated.
#include "io/expression.hpp"

#include "fuzz.hpp"

extern "C" int LLVMFuzzerTestOneInput(std::uint8_t const* data, std::size_t bytes) {
  cayspin::fuzz::refuse_or_read([&] {
    try {
      cayspin::io::Expression const formula(std::string(reinterpret_cast<char const*>(data), bytes),
                                            {"x", "y", "t"});
      double const values[] = {0.25, -2, 3};
      formula(values);
    } catch (std::invalid_argument const& error) {
      throw std::runtime_error(error.what());
    }
  });
  return 0;
}
