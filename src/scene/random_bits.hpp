// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>
#include <string_view>

namespace cayspin::inline v0_2::io::detail {

/// Returns value number `counter`, counted from 0, of the SplitMix64 sequence with seed `start`
/// (Steele, Lea, Flood 2014, doi 10.1145/2660193.2660195), in constant time.
inline std::uint64_t random_bits(std::uint64_t start, std::uint64_t counter) {
  std::uint64_t z = start + (counter + 1) * 0x9e3779b97f4a7c15U;
  z = (z ^ (z >> 30U)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27U)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31U);
}

/// Returns random_bits(start, counter) as a number in [0, 1).
inline double random_number(std::uint64_t start, std::uint64_t counter) {
  return 0x1p-53 * static_cast<double>(random_bits(start, counter) >> 11U);
}

/// Returns the seed of a function in an expression as an integer. Throws std::runtime_error unless
/// it is a whole number from 0 to 2^53.
std::uint64_t whole_seed(double seed, std::string_view function);

}  // namespace cayspin::inline v0_2::io::detail
