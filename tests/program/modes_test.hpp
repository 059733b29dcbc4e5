// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "program_test.hpp"

#include <string>
#include <vector>

namespace cayspin::program::test {

struct Modes : ProgramTest {
  Outcome modes(std::string const& text, Arguments const& more = {}) const {
    return start(joined({"modes", write("scene.toml", text)}, more));
  }
  std::vector<double> numbers(std::string const& dataset) const {
    return read_dataset("modes.h5", dataset).values;
  }
};

}  // namespace cayspin::program::test
