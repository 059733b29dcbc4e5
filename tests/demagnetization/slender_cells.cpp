// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The demagnetising tensor of cells whose longest edge is more than 1000 times the shortest,
// against values computed with 160 digits.
#include "../support/larger.hpp"

#include <cayspin/demagnetization/tensor.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <fstream>
#include <vector>

namespace {

using Lengths = std::array<double, 3>;
using Entries = std::array<double, 6>;  // xx, yy, zz, xy, xz, yz

struct SlenderEntry {
  Lengths position, cell;
  Entries tensor;

  double edge_ratio() const {
    return std::max({cell[0], cell[1], cell[2]}) / std::min({cell[0], cell[1], cell[2]});
  }
};

/// Written by tensor_table.py.
std::vector<SlenderEntry> const slender_table = [] {
  std::ifstream file(CAYSPIN_TEST_DATA "/slender_demagnetizing_tensors.json");
  std::vector<SlenderEntry> table;
  for (auto const& row : nlohmann::json::parse(file))
    table.push_back({row.at("position"), row.at("cell"), row.at("tensor")});
  return table;
}();

TEST(DemagnetizingTensor, OfSlenderCellsIsThatOfTheTable) {
  ASSERT_FALSE(slender_table.empty());
  for (auto const& one : slender_table) {
    auto const n = cayspin::demagnetizing_tensor(one.position, one.cell);
    Entries const found{n.xx, n.yy, n.zz, n.xy, n.xz, n.yz};
    double largest = 0, error = 0;
    for (std::size_t i = 0; i < 6; ++i) {
      largest = cayspin::test::larger(largest, std::abs(one.tensor[i]));
      error = cayspin::test::larger(error, std::abs(found[i] - one.tensor[i]));
    }
    double const relative = one.edge_ratio() < 2e6 ? 3e-11 : 1e-8;
    EXPECT_LE(error, std::min(relative * largest, 1e-15))
        << testing::PrintToString(one.position) << testing::PrintToString(one.cell);
  }
}

TEST(DemagnetizingTensor, OfSlenderCellsHasTheTraceOfTheDivergence) {
  for (auto const& one : slender_table) {
    if (one.position != Lengths{}) continue;
    auto const n = cayspin::demagnetizing_tensor(one.position, one.cell);
    EXPECT_NEAR(n.xx + n.yy + n.zz, 1, 2e-15) << testing::PrintToString(one.cell);
    EXPECT_GT(std::min({n.xx, n.yy, n.zz}), 0) << testing::PrintToString(one.cell);
  }
}

}  // namespace
