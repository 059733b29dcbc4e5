// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// integrator.compensated: in single precision, many short steps end within ten epsilons of a run in
// double precision.
#include "program_test.hpp"

#include <limits>

namespace cayspin::program::test {
namespace {

struct CompensatedRuns : ProgramTest {
  std::vector<double> end(std::string const& integrator, std::string const& precision) const {
    return end_of(chain_scene(),
                  {"--threads", "1", "--precision", precision, "--set", "output.every=10000",
                   "--set", "integrator={dt=1e-4,end=1.0," + integrator + "}"});
  }
};

constexpr char const* methods[] = {"method='rkmk4'",         "method='rkmk4',generator='tangent'",
                                   "method='rkmk5'",         "method='rkmk5',generator='tangent'",
                                   "method='projected_rk4'", "method='projected_rk5'"};

TEST_F(CompensatedRuns, KeepTheDigitsOfDouble) {
  constexpr double epsilon = std::numeric_limits<float>::epsilon();
  for (std::string const method : methods) {
    auto const exact = end(method, "double");
    EXPECT_LT(distance(end(method + ",compensated=true", "single"), exact), 10 * epsilon) << method;
    EXPECT_GT(distance(end(method, "single"), exact), 30 * epsilon) << method;
  }
}

}  // namespace
}  // namespace cayspin::program::test
