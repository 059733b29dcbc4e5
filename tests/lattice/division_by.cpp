// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Division of plane numbers by the planes of a replica, without an integer division.
#include <cayspin/detail/division_by.hpp>

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <random>

namespace cayspin::test {
namespace {

constexpr std::int32_t largest = std::numeric_limits<std::int32_t>::max();

void expect_quotients(std::int32_t divisor, std::int32_t around) {
  detail::DivisionBy const by(divisor);
  for (std::int64_t number = std::int64_t(around) - 2; number <= std::int64_t(around) + 2; ++number)
    if (number >= 0 && number <= largest) {
      ASSERT_EQ(by.quotient(static_cast<std::int32_t>(number)), number / divisor)
          << number << " / " << divisor;
    }
}

TEST(DivisionBy, GivesTheQuotientsOfAllNumbers) {
  std::mt19937 random(1);
  for (int bits = 1; bits <= 31; ++bits)
    for (int i = 0; i < 300; ++i) {
      auto const divisor = static_cast<std::int32_t>(
          i < 3 ? (std::int64_t(1) << (bits - 1)) + i - (i == 2 ? 3 : 0)
                : (std::int64_t(1) << (bits - 1)) + (random() & ((1U << (bits - 1)) - 1)));
      if (divisor < 1) continue;
      expect_quotients(divisor, 0);
      expect_quotients(divisor, largest);
      expect_quotients(divisor, largest / divisor * divisor);
      for (int k = 0; k < 20; ++k) {
        auto const number = static_cast<std::int32_t>(random() >> 1);
        expect_quotients(divisor, number);
        expect_quotients(divisor, number / divisor * divisor);
      }
    }
}

TEST(DivisionBy, IsZeroWithoutADivisor) {
  for (std::int32_t const number : {0, 1, 1000, largest})
    EXPECT_EQ(detail::DivisionBy().quotient(number), 0);
}

}  // namespace
}  // namespace cayspin::test
