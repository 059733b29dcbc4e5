// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// integrator.energy_control makes the drift of the energy at least thirty times smaller.
#include "../support/larger.hpp"
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

struct ControlledEnergy : ProgramTest {
  double drift(std::string const& integrator) const {
    end_of(chain_scene(), set("system.damping=0", "lattice={shape=[4,4,4],boundary='periodic'}",
                              "field={exchange=1.0}", "initial.random.seed=7",
                              "integrator={dt=0.05,end=20.0," + integrator + "}"));
    auto const energies = read_dataset("out.h5", "/energy").values;
    double largest = 0;
    for (double const energy : energies)
      largest = cayspin::test::larger(largest, std::abs(energy - energies.front()));
    return largest / 64;
  }
};

TEST_F(ControlledEnergy, DriftsThirtyTimesLess) {
  for (std::string const method : {"rkmk4", "cf4", "projected_rk4"})
    EXPECT_LT(drift("method='" + method + "',energy_control=true"),
              drift("method='" + method + "'") / 30)
        << method;
}

}  // namespace
}  // namespace cayspin::program::test
