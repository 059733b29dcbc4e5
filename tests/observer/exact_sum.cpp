// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Tests a sum that is rounded only once: against sums of integers, in any order and in parts, and
// at the limits of the range.
#include <cayspin/detail/exact_sum.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace cayspin::inline v0_2::detail {
namespace {

double rounded_sum_of(std::vector<double> const& numbers) {
  ExactSum sum;
  for (double const number : numbers) sum.add(number);
  return sum.rounded();
}

// Integers of at most 2^59 in magnitude. Their sums fit 63 bits and are rounded only when they are
// converted, to nearest.
TEST(ExactSum, RoundsTheSumOfIntegers) {
  std::mt19937_64 engine(3);
  for (int trial = 0; trial < 5000; ++trial) {
    std::vector<double> numbers;
    std::int64_t sum = 0;
    for (auto left = engine() % 7; left > 0; --left) {
      auto const few_bits = static_cast<std::int64_t>(engine() >> 12) - (std::int64_t{1} << 51);
      auto const number = few_bits * (std::int64_t{1} << engine() % 9);
      numbers.push_back(static_cast<double>(number));
      sum += number;
    }
    ASSERT_EQ(rounded_sum_of(numbers), static_cast<double>(sum));
  }
}

TEST(ExactSum, DoesNotDependOnOrderOrParts) {
  std::mt19937_64 engine(5);
  for (int trial = 0; trial < 500; ++trial) {
    std::vector<double> numbers(1 + engine() % 40);
    for (double& number : numbers)
      number = std::ldexp(static_cast<double>(engine() >> 11) - 0x1p52,
                          static_cast<int>(engine() % 1900) - 1000);
    double const expected = rounded_sum_of(numbers);
    std::shuffle(numbers.begin(), numbers.end(), engine);
    ExactSum parts[2];
    for (std::size_t i = 0; i < numbers.size(); ++i) parts[i % 2].add(numbers[i]);
    for (ExactSum& part : parts) part.carry();
    parts[0].add_atomically(parts[1]);
    ASSERT_EQ(parts[0].rounded(), expected);
  }
}

// The sums of as many blocks as a reduction may have, each of many rows. The digits of all rows
// together do not fit into 64 bits.
TEST(ExactSum, HoldsManyRowsInEachOfManyBlocks) {
  constexpr int rows = 3 << 20, blocks = 1024;
  double const number = 0x1p53 - 1;
  ExactSum block, total;
  for (int row = 0; row < rows; ++row) block.add(number);
  for (int i = 0; i < blocks; ++i) total.add_atomically(block);
  EXPECT_EQ(total.rounded(), number * rows * blocks);
}

TEST(ExactSum, LosesNothingBetweenLargeAndSmall) {
  EXPECT_EQ(rounded_sum_of({1e300, 1, -1e300}), 1);
  double const least = std::numeric_limits<double>::denorm_min();
  EXPECT_EQ(rounded_sum_of({least, -3 * least, 1, -1}), -2 * least);
  double const largest = std::numeric_limits<double>::max();
  EXPECT_EQ(rounded_sum_of({largest, largest, -largest}), largest);
  EXPECT_EQ(rounded_sum_of({}), 0);
  // Halfway between two numbers, the sum rounds to the even one, but up if a little more is added.
  EXPECT_EQ(rounded_sum_of({1, 0x1p-53}), 1);
  EXPECT_EQ(rounded_sum_of({1, 0x1p-53, least}), 1 + 0x1p-52);
}

TEST(ExactSum, FindsNumbersThatAreNone) {
  double const infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(rounded_sum_of({1, infinity}), infinity);
  EXPECT_EQ(rounded_sum_of({1, -infinity}), -infinity);
  double const largest = std::numeric_limits<double>::max();
  EXPECT_EQ(rounded_sum_of({largest, largest}), infinity);
  EXPECT_TRUE(std::isnan(rounded_sum_of({infinity, -infinity})));
  EXPECT_TRUE(std::isnan(rounded_sum_of({1, std::nan("")})));
}

}  // namespace
}  // namespace cayspin::inline v0_2::detail
