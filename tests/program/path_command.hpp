// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/attribute.hpp"
#include "hdf5/handle.hpp"
#include "program_test.hpp"

namespace cayspin::program::test {

/// Runs `cayspin path` between two states of three coupled spins.
struct PathCommand : ProgramTest {
  std::string const scene = R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [3]
[field]
exchange = 20.0
anisotropy = [{ constant = 1.3, axis = [0, 0, 1] }, { constant = -0.7, axis = [0, 1, 0] }]
applied = [0.4, 0, 0]
[initial]
uniform = [0, 0, 1]
)toml";

  /// Writes both ends of a path: the scene relaxed from its start and from -z.
  void write_ends(std::string const& text) const {
    auto const file = write("scene.toml", text);
    expect_status(0, {"relax", file, "--output", "a.h5", "--quiet"});
    expect_status(0, {"relax", file, "--output", "b.h5", "--quiet", "--set",
                      "initial={ uniform = [0, 0, -1] }"});
  }
  Arguments arguments(Arguments const& more = {}) const {
    return joined(
        {"path", in_folder("scene.toml"), "--from", "a.h5", "--to", "b.h5", "--output", "path.h5"},
        more);
  }
  double attribute(char const* name) const {
    auto const path = in_folder("path.h5");
    auto const file = io::open_file(path);
    return io::RootAttributes(file.get(), path).read_real(name);
  }
};

}  // namespace cayspin::program::test
