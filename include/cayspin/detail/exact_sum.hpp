// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>

#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace cayspin::inline v0_2::detail {

/// A sum of doubles that is exact until it is rounded, so that its bits do not depend on the order
/// of the summands. It is a fixed-point number of 32-bit digits in 64-bit words, as in R. Neal,
/// "Fast exact summation using small and large superaccumulators" (2015). To add two sums, add
/// their words.
class ExactSum {
 public:
  /// The words are the digits, then three counts: of summands that are NaN, infinity and -infinity.
  static constexpr int digits = 68, words = digits + 3;

  CAYSPIN_DETAIL_NOINLINE void add(double number) {
    auto const bits = std::bit_cast<std::uint64_t>(number);
    auto const exponent = static_cast<int>(bits >> 52 & 0x7ff);
    if (exponent == 0x7ff) [[unlikely]]
      return add_not_finite(number);
    std::uint64_t const fraction = bits & ((std::uint64_t{1} << 52) - 1);
    std::uint64_t const mantissa = exponent > 0 ? fraction | std::uint64_t{1} << 52 : fraction;
    int const place = exponent > 0 ? exponent - 1 : 0, shift = place % digit_bits;
    std::uint64_t const low = (mantissa & digit_mask) << shift;
    std::uint64_t const high = (mantissa >> digit_bits << shift) + (low >> digit_bits);
    std::int64_t* const at = word_ + place / digit_bits;
    std::int64_t const sign = bits >> 63 ? -1 : 1;
    at[0] += sign * static_cast<std::int64_t>(low & digit_mask);
    at[1] += sign * static_cast<std::int64_t>(high & digit_mask);
    at[2] += sign * static_cast<std::int64_t>(high >> digit_bits);
    if (--until_carry_ == 0) carry();
  }

  /// Brings all digits but the last into 0 .. 2^32 - 1. A word can then hold the sum of up to 2^30
  /// such digits.
  void carry() {
    for (int i = 0; i + 1 < digits; ++i) {
      word_[i + 1] += word_[i] >> digit_bits;
      word_[i] &= static_cast<std::int64_t>(digit_mask);
    }
    until_carry_ = most_between_carries;
  }

  /// Adds a sum, which may be carried first; several threads may do so at once. A word can hold the
  /// digits of 1024 such sums.
  CAYSPIN_DETAIL_NOINLINE void add_atomically(ExactSum& other) {
    if (most_between_carries - other.until_carry_ > most_added_uncarried) [[unlikely]]
      other.carry();
    for (int i = 0; i < words; ++i)
      if (other.word_[i] != 0) Kokkos::atomic_add(word_ + i, other.word_[i]);
  }

  std::int64_t* data() { return word_; }
  std::int64_t const* data() const { return word_; }

  /// Returns the sum rounded to nearest.
  CAYSPIN_DETAIL_NOINLINE double rounded() {
    if (std::int64_t const* const special = word_ + digits;
        special[0] > 0 || (special[1] > 0 && special[2] > 0))
      return std::numeric_limits<double>::quiet_NaN();
    else if (special[1] > 0 || special[2] > 0)
      return special[1] > 0 ? infinity : -infinity;
    carry();
    if (word_[digits - 1] >= 0) return rounded_magnitude();
    ExactSum positive;
    for (int i = 0; i < digits; ++i) positive.word_[i] = -word_[i];
    positive.carry();
    return -positive.rounded_magnitude();
  }

 private:
  static constexpr int digit_bits = 32;
  static constexpr std::uint64_t digit_mask = 0xffffffff;
  static constexpr std::int32_t most_between_carries = 1 << 29;
  static constexpr std::int32_t most_added_uncarried = 1 << 20;
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  void add_not_finite(double number) {
    ++word_[digits + (std::isnan(number) ? 0 : number > 0 ? 1 : 2)];
  }

  std::uint64_t digit(int i) const { return i < 0 ? 0 : static_cast<std::uint64_t>(word_[i]); }

  // Returns the sum rounded to nearest. It must be >= 0, and carry() must have been called. The
  // leading 64 bits of the sum are converted to double; the lowest of them is also set if any bit
  // below them is set.
  double rounded_magnitude() const {
    int top = digits - 1;
    while (top > 0 && word_[top] == 0) --top;
    std::uint64_t const pair = digit(top) << digit_bits | digit(top - 1);
    if (pair == 0) return 0;
    int const shift = std::countl_zero(pair);
    std::uint64_t const third = digit(top - 2) << shift;
    std::uint64_t bits = pair << shift | third >> digit_bits;
    bool more = (third & digit_mask) != 0;
    for (int i = top - 3; i >= 0 && !more; --i) more = word_[i] != 0;
    if (more) bits |= 1;
    constexpr int smallest = -1074;  // exponent of the lowest bit of digit 0
    return std::ldexp(static_cast<double>(bits), smallest + (top - 1) * digit_bits - shift);
  }

  std::int64_t word_[words] = {};
  std::int32_t until_carry_ = most_between_carries;
};

}  // namespace cayspin::inline v0_2::detail
