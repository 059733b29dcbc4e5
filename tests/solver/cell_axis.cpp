// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Interpolation and restriction along an axis of a multigrid hierarchy, against closed forms.
#include <cayspin/solver/cell_axis.hpp>

#include <gtest/gtest.h>

namespace cayspin::detail {
namespace {

// A set-up that is quadratic in the cells would take hours.
TEST(CellAxis, OfMillionsOfCellsIsThatOfAFew) {
  for (bool const periodic : {true, false})
    for (std::size_t const odd : {0U, 1U}) {
      CellAxis const few(static_cast<std::int64_t>(64 + odd), periodic),
          many(static_cast<std::int64_t>(4'000'000 + odd), periodic);
      auto const of_few = few.restriction(), of_many = many.restriction();
      ASSERT_EQ(of_many.size(), 2'000'000U);
      std::size_t const middle = 1'000'000;
      EXPECT_EQ(of_many[middle], of_few[16]);
      EXPECT_EQ(of_many.front(), of_few.front());
      EXPECT_EQ(of_many.back(), of_few.back());
      for (std::size_t const cell : {2 * middle, 2 * middle + 1}) {
        auto const [beside, share] = many.interpolation(cell);
        EXPECT_EQ(share, 0.25);
        EXPECT_EQ(beside, cell % 2 == 0 ? middle - 1 : middle + 1);
      }
      EXPECT_EQ(many.coarser().largest_sum(), few.coarser().largest_sum());
    }
}

// What restricts is the transpose of what interpolates: both keep sums.
TEST(CellAxis, RestrictsBySumsOfOne) {
  for (std::int64_t const cells : {2, 3, 5, 8, 13})
    for (bool const periodic : {true, false}) {
      CellAxis const axis(cells, periodic);
      double all = 0;
      for (auto const& weights : axis.restriction()) {
        double sum = 0;
        for (double const weight : weights) sum += weight;
        EXPECT_GT(sum, 0.5) << cells;
        all += sum;
      }
      EXPECT_GT(all, 0.9 * static_cast<double>(axis.coarse_cells())) << cells;
    }
}

}  // namespace
}  // namespace cayspin::detail
