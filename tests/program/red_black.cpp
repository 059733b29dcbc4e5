// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The red-black splittings as a scene's method: their orders against rkmk4.
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

struct RedBlackMethods : ProgramTest {
  std::vector<double> end(std::string const& integrator) const {
    return end_of(chain_scene(),
                  set("lattice={shape=[4,6],boundary=['periodic','open']}", "field.exchange=0.4",
                      "field.anisotropy={constant=0.5,axis=[0,0.6,0.8]}",
                      "field.applied=['0.3*cos(2*t)','0.3*sin(2*t)','0.2']",
                      "initial.random.seed=5", "integrator={" + integrator + ",end=1.0}"));
  }
};

TEST_F(RedBlackMethods, HaveTheirOrders) {
  auto const exact = end("method='rkmk4',dt=0.001");
  for (int const order : {2, 4}) {
    double errors[2];
    for (int i = 0; i < 2; ++i)
      errors[i] = distance(exact, end("method='red_black" + std::to_string(order) +
                                      "',dt=" + (i == 0 ? "0.05" : "0.025")));
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.3);
  }
}

}  // namespace
}  // namespace cayspin::program::test
