// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <string>

namespace cayspin::program::test {

/// Returns the scene of a chain that comes to rest early in a run to t = 20, followed by the given
/// tables.
inline std::string early_rest(std::string const& integrator_and_output) {
  return R"toml([system]
kind = "llg"
damping = 1.0
precession = false
[lattice]
shape = [20]
[field]
exchange = 1.0
applied = [5.0, 0.0, 0.0]
[initial]
expression = ["0.3+0.2*cos(pi*x)", "0.5+0.1*cos(2*pi*x)", "0.8"]
)toml" + integrator_and_output;
}

}  // namespace cayspin::program::test
