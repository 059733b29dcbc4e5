// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The demagnetising tensor by mumax3's quadrature, as in examples/standard_problem_4.
#include "../../examples/standard_problem_4/quadrature.hpp"

#include "../support/larger.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace {

using cayspin::DemagnetizingTensor;
using cayspin::test::larger;

double largest_difference(DemagnetizingTensor const& a, DemagnetizingTensor const& b) {
  double largest = 0;
  for (double const d :
       {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz})
    largest = larger(largest, std::abs(d));
  return largest;
}

TEST(Quadrature, ErrsLittle) {
  std::array<double, 3> const thin{500. / 128, 125. / 32, 3};
  double largest = 0;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      std::array<double, 3> const r{x * thin[0], y * thin[1], 0};
      largest = larger(largest, largest_difference(quadrature::tensor(r, thin),
                                                   cayspin::demagnetizing_tensor(r, thin)));
    }
  EXPECT_LT(largest, 2.5e-4);
  EXPECT_GT(largest, 2e-4);
}

}  // namespace
