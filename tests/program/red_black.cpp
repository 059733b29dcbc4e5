// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The red-black splittings as a scene's method: their orders against rkmk4.
#include "program_test.hpp"

#include <cmath>

namespace cayspin::program::test {
namespace {

struct RedBlackMethods : ProgramTest {
  std::vector<double> end(std::string const& integrator) const {
    auto const outcome = start({"run", write("scene.toml", R"toml([system]
kind = "llg"
damping = 0.1
[lattice]
shape = [4, 6]
boundary = ["periodic", "open"]
[field]
exchange = 0.4
anisotropy = { constant = 0.5, axis = [0, 0.6, 0.8] }
applied = ["0.3*cos(2*t)", "0.3*sin(2*t)", "0.2"]
slab_demag = { normal = [1, 0, 0] }
[initial]
random = { seed = 5 }
[integrator]
method = "rkmk4"
dt = 0.001
end = 1.0
)toml"),
                                "--quiet", "--output", "out.h5", "--overwrite", "--set",
                                "integrator={" + integrator + ",end=1.0}"});
    EXPECT_EQ(outcome.status, 0) << outcome.errors;
    return last_spins("out.h5");
  }
};

TEST_F(RedBlackMethods, HaveTheirOrders) {
  auto const exact = end("method='rkmk4',dt=0.001");
  for (int const order : {2, 4}) {
    double errors[2];
    for (int i = 0; i < 2; ++i) {
      auto const numbers =
          end("method='red_black" + std::to_string(order) + "',dt=" + (i == 0 ? "0.05" : "0.025"));
      ASSERT_EQ(numbers.size(), exact.size());
      errors[i] = 0;
      for (std::size_t n = 0; n < exact.size(); ++n)
        errors[i] = std::max(errors[i], std::abs(numbers[n] - exact[n]));
    }
    EXPECT_NEAR(std::log2(errors[0] / errors[1]), order, 0.3);
  }
}

}  // namespace
}  // namespace cayspin::program::test
