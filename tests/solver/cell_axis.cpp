// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Interpolation and restriction along an axis of a multigrid hierarchy, compared with closed forms.
#include <cayspin/solver/cell_axis.hpp>

#include <gtest/gtest.h>

namespace cayspin::detail {
namespace {

// A set-up whose time is quadratic in the number of cells would take hours.
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

// The weights of an interpolation add up to 1, so its transpose keeps the sum over cells.
TEST(CellAxis, RestrictionKeepsSums) {
  for (std::size_t const cells : {2U, 3U, 5U, 8U, 13U})
    for (bool const periodic : {true, false}) {
      CellAxis const axis(static_cast<std::int64_t>(cells), periodic);
      auto const restriction = axis.restriction();
      double all = 0;
      for (std::size_t to = 0; to < restriction.size(); ++to) {
        double const width = to + 1 == restriction.size() && cells % 2 == 1 ? 3 : 2;
        for (double const weight : restriction[to]) all += width * weight;
      }
      EXPECT_NEAR(all, static_cast<double>(cells), 1e-14 * static_cast<double>(cells));
    }
}

}  // namespace
}  // namespace cayspin::detail
