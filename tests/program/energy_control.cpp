// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// integrator.energy_control: the energy stays where the run began, with any method.
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

struct ControlledEnergy : ProgramTest {
  double drift(std::string const& integrator) const {
    auto const outcome = start({"run", write("scene.toml", R"toml([system]
kind = "llg"
damping = 0.0
[lattice]
shape = [4, 4, 4]
boundary = "periodic"
[field]
exchange = 1.0
[initial]
random = { seed = 7 }
[integrator]
method = "rkmk4"
dt = 0.05
end = 20.0
[output]
every = 10
)toml"),
                                "--quiet", "--output", "out.h5", "--overwrite", "--set",
                                "integrator={dt=0.05,end=20.0," + integrator + "}"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    auto const energies = read_dataset("out.h5", "/energy").values;
    double largest = 0;
    for (double const energy : energies)
      largest = std::max(largest, std::abs(energy - energies.front()));
    return largest / 64;
  }
};

TEST_F(ControlledEnergy, DriftsThirtyTimesLess) {
  for (std::string const method : {"rkmk4", "cf4", "fx4", "projected_rk4"})
    EXPECT_LT(drift("method='" + method + "',energy_control=true"),
              drift("method='" + method + "'") / 30)
        << method;
}

}  // namespace
}  // namespace cayspin::program::test
