// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Philox4x32-10 has the known answers that its authors publish with Random123.
#include <cayspin/detail/philox.hpp>

#include <Kokkos_Core.hpp>
#include <gtest/gtest.h>

#include <array>

namespace cayspin::inline v0_2::detail {
namespace {

struct Answer {
  std::array<std::uint32_t, 4> counter;
  std::array<std::uint32_t, 2> key;
  std::array<std::uint32_t, 4> words;
};
constexpr std::uint32_t all = 0xffffffff;
constexpr Answer answers[] = {
    {{0, 0, 0, 0}, {0, 0}, {0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}},
    {{all, all, all, all}, {all, all}, {0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}},
    {{0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344},
     {0xa4093822, 0x299f31d0},
     {0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}}};

TEST(Philox, GivesTheKnownAnswersInEveryLane) {
  for (auto const& answer : answers) {
    auto const words = [](std::uint32_t low, std::uint32_t high) {
      return std::uint64_t{high} << 32U | low;
    };
    auto const& [counter, key, expected] = answer;
    std::uint64_t const number = words(counter[0], counter[1]),
                        draw = words(counter[2], counter[3]);
    PhiloxKeys const keys(words(key[0], key[1]));
    Philox<1> alone(number, draw);
    encrypt(keys, alone);
    for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(alone.word[i] & all, expected[i]);
#if !defined(KOKKOS_ENABLE_CUDA)  // nvcc rejects vectors in functions for host and device
    Philox<8> fourth(number - 3, draw), first(number, draw);
    encrypt(keys, fourth, first);
    for (std::size_t i = 0; i < 4; ++i) {
      EXPECT_EQ(fourth.word[i][3] & all, expected[i]);
      EXPECT_EQ(first.word[i][0] & all, expected[i]);
    }
#endif
  }
}

}  // namespace
}  // namespace cayspin::inline v0_2::detail
