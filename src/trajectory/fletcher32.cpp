// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "fletcher32.hpp"

#include <algorithm>

namespace cayspin::inline v0_2::io {
namespace {

// Reduces a sum modulo 65535, except that a multiple of 65535 other than 0 becomes 65535.
std::uint64_t folded(std::uint64_t sum) {
  while (sum > 0xffff) sum = (sum & 0xffff) + (sum >> 16);
  return sum;
}

}  // namespace

void Fletcher32::add(std::span<std::byte const> bytes) {
  constexpr std::size_t words_between_folds = std::size_t{1} << 20U;  // the sums stay below 2^57
  std::uint64_t sum = sum_, sum_of_sums = sum_of_sums_;
  auto const* data = bytes.data();
  for (std::size_t left = bytes.size() / 2; left > 0;) {
    auto const words = std::min(left, words_between_folds);
    left -= words;
    for (auto const* const end = data + 2 * words; data != end; data += 2) {
      sum +=
          std::to_integer<std::uint64_t>(data[0]) << 8U | std::to_integer<std::uint64_t>(data[1]);
      sum_of_sums += sum;
    }
    sum = folded(sum);
    sum_of_sums = folded(sum_of_sums);
  }
  sum_ = sum;
  sum_of_sums_ = sum_of_sums;
}

std::uint32_t Fletcher32::value() const {
  return static_cast<std::uint32_t>(sum_of_sums_ << 16U | sum_);
}

}  // namespace cayspin::inline v0_2::io
