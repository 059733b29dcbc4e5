// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "larger.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::test {

/// Returns the largest defect in the conditions of order `of_order` (at most 6), for weights w at
/// fraction s of a step.
template <class Tableau, class Weight>
double defect(int of_order, double s, Weight const& w) {
  constexpr int n = Tableau::stages;
  using Column = std::array<double, n>;
  auto const times_a = [](Column const& v) {
    Column product{};
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < i; ++j) product[i] += Tableau::a[i][j] * v[j];
    return product;
  };
  auto const by = [](Column v, Column const& other) {
    for (int i = 0; i < n; ++i) v[i] *= other[i];
    return v;
  };
  Column one, c;
  one.fill(1);
  c = times_a(one);
  Column const cc = by(c, c), ac = times_a(c), ccc = by(cc, c), acc = times_a(cc);
  std::vector<std::pair<Column, double>> conditions;  // with the density of the tree
  if (of_order == 1) conditions = {{one, 1}};
  if (of_order == 2) conditions = {{c, 2}};
  if (of_order == 3) conditions = {{cc, 3}, {ac, 6}};
  if (of_order == 4) conditions = {{ccc, 4}, {by(c, ac), 8}, {acc, 12}, {times_a(ac), 24}};
  if (of_order == 5)
    conditions = {
        {by(ccc, c), 5},          {by(cc, ac), 10},           {by(ac, ac), 20},
        {by(c, acc), 15},         {times_a(ccc), 20},         {by(c, times_a(ac)), 30},
        {times_a(by(c, ac)), 40}, {times_a(times_a(cc)), 60}, {times_a(times_a(ac)), 120}};
  if (of_order == 6) {
    Column const c4 = by(cc, cc), aac = times_a(ac), accc = times_a(ccc), c_ac = by(c, ac);
    conditions = {{by(c4, c), 6},
                  {by(ccc, ac), 12},
                  {by(c, by(ac, ac)), 24},
                  {by(cc, acc), 18},
                  {by(ac, acc), 36},
                  {by(c, accc), 24},
                  {times_a(c4), 30},
                  {by(cc, aac), 36},
                  {by(ac, aac), 72},
                  {by(c, times_a(c_ac)), 48},
                  {times_a(by(cc, ac)), 60},
                  {times_a(by(ac, ac)), 120},
                  {by(c, times_a(acc)), 72},
                  {times_a(by(c, acc)), 90},
                  {times_a(accc), 120},
                  {by(c, times_a(aac)), 144},
                  {times_a(by(c, aac)), 180},
                  {times_a(times_a(c_ac)), 240},
                  {times_a(times_a(acc)), 360},
                  {times_a(times_a(aac)), 720}};
  }
  double largest = 0;
  for (auto const& [column, density] : conditions) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += w(i) * column[i];
    largest = larger(largest, std::abs(sum - std::pow(s, of_order) / density));
  }
  return largest;
}

/// Expects weights to satisfy the conditions up to `order` (at most 6) within `exact`, and to miss
/// those of the next order, if that is at most 6, by more than `missed`.
template <class Tableau, class Weight>
void expect_conditions(char const* name, int order, double exact, double missed, Weight const& w,
                       double s = 1) {
  for (int of_order = 1; of_order <= std::min(order + 1, 6); ++of_order) {
    SCOPED_TRACE(std::string(name) + ", order " + std::to_string(of_order));
    double const largest = defect<Tableau>(of_order, s, w);
    if (of_order <= order)
      EXPECT_LT(largest, exact);
    else
      EXPECT_GT(largest, missed);
  }
}
/// Expects the weights b of a tableau to satisfy the conditions up to its order, and to miss those
/// of the next order.
template <class Tableau>
void expect_conditions(char const* name, double exact, double missed = 1e-3) {
  expect_conditions<Tableau>(name, Tableau::order, exact, missed,
                             [](int i) { return Tableau::b[i]; });
}

}  // namespace cayspin::test
