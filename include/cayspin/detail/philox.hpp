// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/pack.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace cayspin::detail {

// Numbers side by side in registers, by the vectors of GCC and Clang.
template <class Number, int Lanes>
struct LanesOf {
  typedef Number type __attribute__((vector_size(sizeof(Number) * Lanes)));
};
template <class Number>
struct LanesOf<Number, 1> {
  using type = Number;
};

/// Philox4x32-10 of J. Salmon, M. Moraes, R. Dror and D. Shaw, "Parallel random numbers: as easy as
/// 1, 2, 3" (2011): four random words for each counter of four words, under a key of two. Several
/// counters side by side; of each number the upper half is 0.
template <int Lanes>
struct Philox {
  using Words = typename LanesOf<std::uint64_t, Lanes>::type;
  Words word[4];

  /// Counters (number + lane, draw).
  KOKKOS_FORCEINLINE_FUNCTION Philox(std::uint64_t number, std::uint64_t draw) {
    std::uint64_t numbers[std::size_t{Lanes}];
    for (int lane = 0; lane < Lanes; ++lane)
      numbers[lane] = number + static_cast<std::uint64_t>(lane);
    Words all;
    std::memcpy(&all, numbers, sizeof all);
    word[0] = all & low_half;
    word[1] = all >> 32;
    word[2] = (all ^ all) + (draw & low_half);
    word[3] = (all ^ all) + (draw >> 32U);
  }

  KOKKOS_FORCEINLINE_FUNCTION void encrypt(std::uint64_t key) {
    constexpr std::uint64_t multiplier_0 = 0xD2511F53, multiplier_1 = 0xCD9E8D57;
    constexpr std::uint64_t step_0 = 0x9E3779B9, step_1 = 0xBB67AE85;
    std::uint64_t key_0 = key & low_half, key_1 = key >> 32U;
    for (int round = 0; round < 10; ++round) {
      // Upper halves are of no account until the end.
      Words const a = product(word[0], multiplier_0), b = product(word[2], multiplier_1);
      word[0] = (b >> 32) ^ word[1] ^ key_0;
      word[1] = b;
      word[2] = (a >> 32) ^ word[3] ^ key_1;
      word[3] = a;
      key_0 = (key_0 + step_0) & low_half;
      key_1 = (key_1 + step_1) & low_half;
    }
    for (Words& one : word) one &= low_half;
  }

 private:
  static constexpr std::uint64_t low_half = 0xFFFFFFFF;

  /// Of lower halves. The processor has an instruction for them that g++ does not find.
  KOKKOS_FORCEINLINE_FUNCTION static Words product(Words const& a, std::uint64_t b) {
#if defined(CAYSPIN_DETAIL_AVX512) && !defined(__CUDACC__)
    if constexpr (Lanes == 8)
      return reinterpret_cast<Words>(_mm512_maskz_mul_epu32(
          0xff, reinterpret_cast<__m512i>(a), _mm512_set1_epi64(static_cast<std::int64_t>(b))));
#endif
    return (a & low_half) * b;
  }
};

}  // namespace cayspin::detail
