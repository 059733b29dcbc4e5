// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The demagnetising tensor against a table computed with 160 digits, and its general properties.
#include "../support/larger.hpp"

#include <cayspin/demagnetization/tensor.hpp>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

namespace {

using cayspin::demagnetizing_tensor;
using cayspin::test::larger;
using Lengths = std::array<double, 3>;
using Entries = std::array<double, 6>;  // xx, yy, zz, xy, xz, yz

struct TensorEntry {
  Lengths position, cell;
  Entries tensor;
};

/// Written by tensor_table.py.
std::vector<TensorEntry> const tensor_table = [] {
  std::ifstream file(CAYSPIN_TEST_DATA "/demagnetizing_tensors.json");
  std::vector<TensorEntry> table;
  for (auto const& row : nlohmann::json::parse(file))
    table.push_back({row.at("position"), row.at("cell"), row.at("tensor")});
  return table;
}();

Entries entries(Lengths const& position, Lengths const& cell) {
  auto const n = demagnetizing_tensor(position, cell);
  return {n.xx, n.yy, n.zz, n.xy, n.xz, n.yz};
}

double largest(Entries const& a) {
  double result = 0;
  for (double const x : a) result = larger(result, std::abs(x));
  return result;
}

double largest_difference(Entries const& a, Entries const& b) {
  Entries difference{};
  for (std::size_t i = 0; i < 6; ++i) difference[i] = a[i] - b[i];
  return largest(difference);
}

double longest(Lengths const& cell) { return std::max({cell[0], cell[1], cell[2]}); }

/// Returns the distance, in units of the cell's longest edge.
double distance(TensorEntry const& one) {
  return std::hypot(one.position[0], one.position[1], one.position[2]) / longest(one.cell);
}

/// Returns the largest error at distances from `begin` to `end` longest edges. Each error is
/// relative to the largest entry of its tensor. The table has eight cells, with at least five
/// positions of each in such a range.
double error_between(double begin, double end) {
  double worst = 0;
  int compared = 0;
  for (TensorEntry const& one : tensor_table)
    if (distance(one) >= begin && distance(one) < end) {
      worst = larger(worst, largest_difference(entries(one.position, one.cell), one.tensor) /
                                largest(one.tensor));
      ++compared;
    }
  EXPECT_GE(compared, 8 * 5);
  std::printf("from %g to %g edges: %.2g\n", begin, end, worst);
  return worst;
}

TEST(DemagnetizingTensor, IsThatOfTheTableNearby) { EXPECT_LE(error_between(0, 4), 1e-11); }

// Each of these ranges of distance has a separate series, which would exceed the bound if its order
// were lower by 2.
TEST(DemagnetizingTensor, IsThatOfTheTableFarAway) {
  EXPECT_LE(error_between(4, 8), 1e-12);
  EXPECT_LE(error_between(8, 50), 1e-12);
  EXPECT_LE(error_between(50, 1e6), 1e-12);
}

// Bounds on absolute errors: the tensor of a cell with itself has the trace 1.
TEST(DemagnetizingTensor, IsThatOfTheTableToRoundOffBesideTheCell) {
  for (TensorEntry const& one : tensor_table) {
    if (distance(one) > 1.5) continue;
    double const shortest = std::min({one.cell[0], one.cell[1], one.cell[2]});
    EXPECT_LE(largest_difference(entries(one.position, one.cell), one.tensor),
              longest(one.cell) < 200 * shortest ? 5e-16 : 1e-13)
        << testing::PrintToString(one.position) << testing::PrintToString(one.cell);
  }
}

// The trace is 1 for the cell itself and 0 elsewhere, as the divergence of the field requires.
TEST(DemagnetizingTensor, HasTheTraceOfTheDivergence) {
  for (TensorEntry const& one : tensor_table) {
    auto const n = demagnetizing_tensor(one.position, one.cell);
    EXPECT_NEAR(n.xx + n.yy + n.zz, distance(one) > 0 ? 0 : 1, 1e-13);
  }
}

TEST(DemagnetizingTensor, OfACubeIsAThird) {
  auto const n = demagnetizing_tensor({0, 0, 0}, {2, 2, 2});
  EXPECT_NEAR(n.xx, 1. / 3, 1e-16);
  EXPECT_NEAR(n.yy, 1. / 3, 1e-16);
  EXPECT_NEAR(n.zz, 1. / 3, 1e-16);
}

TEST(DemagnetizingTensor, IsEvenAndOddToTheLastBit) {
  for (TensorEntry const& one : tensor_table) {
    auto const [x, y, z] = one.position;
    Entries const n = entries({x, y, z}, one.cell);
    EXPECT_EQ(entries({-x, y, z}, one.cell), (Entries{n[0], n[1], n[2], -n[3], -n[4], n[5]}));
    EXPECT_EQ(entries({x, -y, z}, one.cell), (Entries{n[0], n[1], n[2], -n[3], n[4], -n[5]}));
    EXPECT_EQ(entries({x, y, -z}, one.cell), (Entries{n[0], n[1], n[2], n[3], -n[4], -n[5]}));
    EXPECT_EQ(entries({-x, -y, -z}, one.cell), n);
    EXPECT_EQ(n[3] == 0, x == 0 || y == 0);
    EXPECT_EQ(n[4] == 0, x == 0 || z == 0);
    EXPECT_EQ(n[5] == 0, y == 0 || z == 0);
  }
}

TEST(DemagnetizingTensor, TurnsWithTheAxes) {
  for (TensorEntry const& one : tensor_table) {
    auto const [x, y, z] = one.position;
    auto const [a, b, c] = one.cell;
    Entries const n = entries({x, y, z}, {a, b, c});
    double const bound = (distance(one) < 4 ? 1e-11 : 1e-12) * largest(n);
    EXPECT_LE(
        largest_difference(entries({y, z, x}, {b, c, a}), {n[1], n[2], n[0], n[5], n[3], n[4]}),
        bound);
    EXPECT_LE(
        largest_difference(entries({y, x, z}, {b, a, c}), {n[1], n[0], n[2], n[3], n[5], n[4]}),
        bound);
  }
}

TEST(DemagnetizingTensor, DoesNotDependOnTheUnit) {
  for (TensorEntry const& one : tensor_table) {
    constexpr double unit = 0x1p-30;
    auto const [x, y, z] = one.position;
    auto const [a, b, c] = one.cell;
    EXPECT_EQ(entries({unit * x, unit * y, unit * z}, {unit * a, unit * b, unit * c}),
              entries(one.position, one.cell));
  }
}

// Two blocks of 4 x 3 x 2 cells have the tensor of two larger cells.
TEST(DemagnetizingTensor, SumsToThatOfABlock) {
  constexpr Lengths cell{1, 1.5, 0.4}, block{4, 4.5, 0.8};
  for (Lengths const& position : {Lengths{0, 0, 0}, Lengths{4, 0, 0}, Lengths{-3, 7, 5},
                                  Lengths{10, 12, -14}, Lengths{150, -100, 200}}) {
    Entries sum{};
    for (int k = -1; k <= 1; ++k)
      for (int j = -2; j <= 2; ++j)
        for (int i = -3; i <= 3; ++i) {
          int const pairs = (4 - std::abs(i)) * (3 - std::abs(j)) * (2 - std::abs(k));
          Entries const n = entries(
              {position[0] + i * cell[0], position[1] + j * cell[1], position[2] + k * cell[2]},
              cell);
          for (std::size_t e = 0; e < 6; ++e) sum[e] += pairs * n[e] / 24;
        }
    Entries const expected = entries(position, block);
    EXPECT_LE(largest_difference(sum, expected), 1e-12 * largest(expected))
        << testing::PrintToString(position);
  }
}

}  // namespace
