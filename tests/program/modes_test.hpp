// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "program_test.hpp"

#include <string>
#include <vector>

namespace cayspin::program::test {

inline std::string const film = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [8, 6]
[field]
exchange = 10.0
anisotropy = { constant = 0.1, axis = [1, 0, 0] }
slab_demag = { normal = [0, 0, 1] }
[initial]
uniform = [1, 0.1, 0.1]
[integrator]
method = "heun"
dt = 0.01
steps = 1
)toml";

struct Modes : ProgramTest {
  Outcome modes(std::string const& text, Arguments const& more = {}) const {
    return start(joined({"modes", write("scene.toml", text)}, more));
  }
  std::vector<double> numbers(std::string const& dataset) const {
    return read_dataset("modes.h5", dataset).values;
  }
};

}  // namespace cayspin::program::test
