// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/execution.hpp>
#include <cayspin/detail/pack.hpp>

#include <cstddef>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

// Integers side by side in a register, by the vector extension of GCC and Clang.
template <class Number, int Lanes>
struct LanesOf {
  typedef Number type __attribute__((vector_size(sizeof(Number) * Lanes)));
};
template <class Number>
struct LanesOf<Number, 1> {
  using type = Number;
};

/// The key schedule of Philox: two words for each round.
struct PhiloxKeys {
  static constexpr int rounds = 10;
  static constexpr std::uint64_t step_0 = 0x9E3779B9, step_1 = 0xBB67AE85;
  std::uint64_t of_round[std::size_t{rounds}][2] = {};

  PhiloxKeys() = default;
  KOKKOS_FORCEINLINE_FUNCTION explicit PhiloxKeys(std::uint64_t key) {
    constexpr std::uint64_t low_half = 0xFFFFFFFF;
    std::uint64_t key_0 = key & low_half, key_1 = key >> 32U;
    for (auto& words : of_round) {
      words[0] = key_0;
      words[1] = key_1;
      key_0 = (key_0 + step_0) & low_half;
      key_1 = (key_1 + step_1) & low_half;
    }
  }
};

/// Philox4x32-10 of J. Salmon, M. Moraes, R. Dror and D. Shaw, "Parallel random numbers: as easy as
/// 1, 2, 3" (2011): four random words for each counter of four words, under a key of two words.
/// `Lanes` counters are side by side. Each 32-bit word is the lower half of a 64-bit number, whose
/// upper half is ignored.
template <int Lanes>
struct Philox {
  using Words = typename LanesOf<std::uint64_t, Lanes>::type;
  Words word[4];

  /// Sets the counter of each lane to (number + lane, draw).
  KOKKOS_FORCEINLINE_FUNCTION Philox(std::uint64_t number, std::uint64_t draw) {
    Words numbers{};
    if constexpr (Lanes == 1) {
      numbers = number;
    } else {
      for (int lane = 0; lane < Lanes; ++lane) numbers[lane] = static_cast<std::uint64_t>(lane);
      numbers += number;
    }
    word[0] = numbers;
    word[1] = numbers >> 32;
    word[2] = (numbers ^ numbers) + draw;
    word[3] = (numbers ^ numbers) + (draw >> 32U);
  }

  /// Returns an object whose counter is (number, draw) in every lane, for lanes that have different
  /// keys.
  KOKKOS_FORCEINLINE_FUNCTION static Philox with_equal_counters(std::uint64_t number,
                                                                std::uint64_t draw) {
    Philox equal(number, draw);
    Words const none = equal.word[0] ^ equal.word[0];
    equal.word[0] = none + number;
    equal.word[1] = none + (number >> 32U);
    return equal;
  }

  /// Performs one round. `key`: two numbers that all lanes share, or two Words with one number per
  /// lane.
  template <class Key>
  KOKKOS_FORCEINLINE_FUNCTION void round(Key const (&key)[2]) {
    Words const a = product(word[0], 0xD2511F53), b = product(word[2], 0xCD9E8D57);
    word[0] = mixed(b >> 32, word[1], key[0]);
    word[1] = b;
    word[2] = mixed(a >> 32, word[3], key[1]);
    word[3] = a;
  }

 private:
  // Where they can, product and mixed use intrinsics, because g++ does not find the single
  // instructions by itself.

  /// Multiplies the lower half of each number of a by b.
  KOKKOS_FORCEINLINE_FUNCTION static Words product(Words const& a, std::uint64_t b) {
#if defined(CAYSPIN_DETAIL_AVX512_OF_INTEGERS)
    if constexpr (Lanes == 8)
      return reinterpret_cast<Words>(_mm512_maskz_mul_epu32(
          0xff, reinterpret_cast<__m512i>(a), _mm512_set1_epi64(static_cast<std::int64_t>(b))));
#elif defined(CAYSPIN_DETAIL_AVX2_OF_INTEGERS)
    if constexpr (Lanes == 4)
      return reinterpret_cast<Words>(_mm256_mul_epu32(
          reinterpret_cast<__m256i>(a), _mm256_set1_epi64x(static_cast<std::int64_t>(b))));
#endif
    return (a & 0xFFFFFFFF) * b;
  }
  /// Returns a ^ b ^ key.
  KOKKOS_FORCEINLINE_FUNCTION static Words mixed(Words const& a, Words const& b,
                                                 std::uint64_t key) {
#if defined(CAYSPIN_DETAIL_AVX512_OF_INTEGERS)
    if constexpr (Lanes == 8)
      return reinterpret_cast<Words>(
          _mm512_ternarylogic_epi64(reinterpret_cast<__m512i>(a), reinterpret_cast<__m512i>(b),
                                    _mm512_set1_epi64(static_cast<std::int64_t>(key)), 0x96));
#endif
    return a ^ b ^ key;
  }
  KOKKOS_FORCEINLINE_FUNCTION static Words mixed(Words const& a, Words const& b, Words const& keys)
    requires(Lanes > 1)
  {
    return a ^ b ^ keys;
  }
};

/// Turns counters into random words. Several generators are interleaved, because each is a long
/// chain of dependent operations.
template <int Lanes, class... Others>
KOKKOS_FORCEINLINE_FUNCTION void encrypt(PhiloxKeys const& keys, Philox<Lanes>& random,
                                         Others&... others) {
  for (auto const& key : keys.of_round) {
    random.round(key);
    (others.round(key), ...);
  }
}

/// Turns counters into random words, with keys first_key, first_key + 1, .. in the lanes.
template <int Lanes, class... Others>
KOKKOS_FORCEINLINE_FUNCTION void encrypt_with_keys(std::uint64_t first_key, Philox<Lanes>& random,
                                                   Others&... others) {
  using Words = typename Philox<Lanes>::Words;
  Words keys{};
  if constexpr (Lanes == 1) {
    keys = first_key;
  } else {
    for (int lane = 0; lane < Lanes; ++lane) keys[lane] = static_cast<std::uint64_t>(lane);
    keys += first_key;
  }
  Words key[2] = {keys, keys >> 32U};
  for (int round = 0; round < PhiloxKeys::rounds; ++round) {
    random.round(key);
    (others.round(key), ...);
    key[0] += PhiloxKeys::step_0;
    key[1] += PhiloxKeys::step_1;
  }
}

}  // namespace cayspin::inline v0_2::detail
