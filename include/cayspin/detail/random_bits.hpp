// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/philox.hpp>

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace cayspin::inline v0_2::detail {

template <bool Keeps>
class RandomBitsOfColumns;

/// 16 random bits for each place, by Philox. A place is a number, for example that of a site; eight
/// counters serve 64 places. A place gets the same bits whether it is drawn by itself or with
/// others in a register. Devices draw for one place at a time.
template <bool OnHost>
class RandomBits {
  template <bool>
  friend class RandomBitsOfColumns;

 public:
  /// Largest number of places in one register. The first place in a register must be a multiple of
  /// the number of places in it.
  static constexpr std::uint64_t most_lanes = 16;

  RandomBits() = default;
  KOKKOS_FORCEINLINE_FUNCTION RandomBits(std::uint64_t seed, std::uint64_t draw)
      : keys_(seed), draw_(draw) {}

  /// Returns numbers whose lower 16 bits belong to `place` and the places after it. The upper bits
  /// are unspecified.
  template <class Number, int Lanes>
  KOKKOS_FORCEINLINE_FUNCTION typename LanesOf<Number, Lanes>::type get(std::uint64_t place) const {
    if constexpr (Lanes == 1) {
      return static_cast<Number>(alone(place));
    } else {
      static_assert(most_lanes % Lanes == 0);
      if (auto const block = place / drawn_at_once; block != last_.block) draw(block);
      return widened<Number, Lanes>(last_.drawn + place % drawn_at_once);
    }
  }

 private:
  // Place p = 0 .. 63 in a group of 64 uses 16 bits of one of the four random words that the
  // counter p % 16 / 2 gives: of word p / 16 % 2 * 2 + p % 2, the lower half if p < 32, otherwise
  // the upper half. With two words packed into each 64-bit number, the numbers in memory are then
  // in the order of the places.
  static constexpr int lanes = host_lanes<double>, counters = 8;
  static constexpr std::uint64_t places = 64, drawn_at_once = 2 * places;

  KOKKOS_FORCEINLINE_FUNCTION std::uint64_t alone(std::uint64_t place) const {
    Philox<1> random(counter_of(place), draw_);
    encrypt(keys_, random);
    return bits_of(place, random);
  }
  KOKKOS_FORCEINLINE_FUNCTION static std::uint64_t counter_of(std::uint64_t place) {
    return place / places * counters + place % 16 / 2;
  }
  template <int Lanes>
  KOKKOS_FORCEINLINE_FUNCTION static typename Philox<Lanes>::Words bits_of(
      std::uint64_t place, Philox<Lanes> const& random) {
    using Words = typename Philox<Lanes>::Words;
    // All indices are constants: with variable ones, a device would keep the array on its stack,
    // which is slow.
    auto const& word = random.word;
    Words const even = place % 32 < 16 ? word[0] : word[2];
    Words const odd = place % 32 < 16 ? word[1] : word[3];
    Words const found = place % 2 == 0 ? even : odd;
    return found >> place % places / 32 * 16;
  }

  KOKKOS_FORCEINLINE_FUNCTION void draw(std::uint64_t block) const {
    for (int counter = 0; counter < 2 * counters; counter += 2 * lanes) {
      auto const number = 2 * block * counters + static_cast<std::uint64_t>(counter);
      Philox<lanes> first(number, draw_), second(number + lanes, draw_);
      encrypt(keys_, first, second);
      keep(first, counter);
      keep(second, counter + lanes);
    }
    last_.block = block;
  }
  KOKKOS_FORCEINLINE_FUNCTION void keep(Philox<lanes> const& random, int counter) const {
    std::uint32_t* const to = last_.drawn + counter / counters * 64 + counter % counters * 2;
    for (int k = 0; k < 2; ++k) {
      auto const words = (random.word[2 * k] & 0xFFFFFFFF) | (random.word[2 * k + 1] << 32);
      auto const upper = words >> 16;
      std::memcpy(to + 16 * k, &words, sizeof words);
      std::memcpy(to + 16 * k + 32, &upper, sizeof upper);
    }
  }

  template <class Number, int Lanes>
  KOKKOS_FORCEINLINE_FUNCTION static auto widened(std::uint32_t const* from) {
    using Numbers = typename LanesOf<Number, Lanes>::type;
#if defined(CAYSPIN_DETAIL_AVX512_OF_INTEGERS)
    if constexpr (sizeof(Number) == 8 && Lanes == 8)  // g++ would take five instructions
      return reinterpret_cast<Numbers>(_mm512_maskz_cvtepu32_epi64(
          0xff, _mm256_loadu_si256(reinterpret_cast<__m256i const*>(from))));
#endif
    typename LanesOf<std::uint32_t, Lanes>::type found;
    std::memcpy(&found, from, sizeof found);
    return __builtin_convertvector(found, Numbers);
  }

  // The bits that were drawn last. The next register of a row usually needs some of them.
  struct Last {
    std::uint64_t block = ~std::uint64_t{0};
    alignas(64) std::uint32_t drawn[std::size_t{drawn_at_once}] = {};
  };
  struct Nothing {};

  PhiloxKeys keys_;
  std::uint64_t draw_ = 0;
  mutable std::conditional_t<OnHost, Last, Nothing> last_;
};

/// Random bits for lattices that are stored side by side, one lattice per column: at each place,
/// column c gets the bits that a RandomBits with seed + c has there. `Keeps`, only on hosts: keeps
/// the words that a register of columns drew last for each counter, because eight places share
/// them. A loop should then visit all places of a register's columns before those of the next one.
template <bool Keeps>
class RandomBitsOfColumns {
 public:
  RandomBitsOfColumns() = default;
  RandomBitsOfColumns(std::uint64_t seed, std::uint64_t draw) : seed_(seed), draw_(draw) {}

  template <class Number, int Lanes>
  KOKKOS_FORCEINLINE_FUNCTION typename LanesOf<Number, Lanes>::type get(std::uint64_t column,
                                                                        std::uint64_t place) const {
    constexpr int together = Lanes == 1 ? 1 : lanes;
    static_assert(Lanes == together || Lanes == most_registers * together);
    auto const first = words<together>(column, place, 0);
    if constexpr (Lanes == together)
      return numbers_of<Number>(first);
    else
      return both<Number>(first, words<together>(column + lanes, place, 1));
  }

 private:
  using Bits = RandomBits<false>;
  static constexpr int lanes = host_lanes<double>, most_registers = 2;

  template <int Lanes>
  KOKKOS_FORCEINLINE_FUNCTION typename Philox<Lanes>::Words words(std::uint64_t column,
                                                                  std::uint64_t place,
                                                                  int number) const {
    std::uint64_t const counter = Bits::counter_of(place);
    if constexpr (Keeps && Lanes > 1) {
      auto& kept = kept_.of[number][counter % Bits::counters / 2];
      if (kept.column != column || kept.counter != counter / 2) draw(kept, column, counter / 2);
      return Bits::bits_of(place, kept.random[counter % 2]);
    } else {
      auto random = Philox<Lanes>::with_equal_counters(counter, draw_);
      encrypt_with_keys(seed_ + column, random);
      return Bits::bits_of(place, random);
    }
  }
  template <class Number, class Words>
  KOKKOS_FORCEINLINE_FUNCTION static auto numbers_of(Words const& bits) {
    if constexpr (std::is_integral_v<Words>)
      return static_cast<Number>(bits);
    else
      return __builtin_convertvector(
          bits, typename LanesOf<Number, sizeof(Words) / sizeof(std::uint64_t)>::type);
  }
  /// Returns the numbers of two registers in one. g++ would take them through memory, and reading
  /// there what two stores wrote is slow.
  template <class Number, class Words>
  KOKKOS_FORCEINLINE_FUNCTION static auto both(Words const& first, Words const& second) {
    static_assert(sizeof(Number) == 4);
    using Numbers = typename LanesOf<Number, 2 * lanes>::type;
#if defined(CAYSPIN_DETAIL_AVX512_OF_INTEGERS)
    if constexpr (lanes == 8)
      return reinterpret_cast<Numbers>(_mm512_permutex2var_epi32(
          reinterpret_cast<__m512i>(first),
          _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30),
          reinterpret_cast<__m512i>(second)));
#elif defined(CAYSPIN_DETAIL_AVX2_OF_INTEGERS)
    if constexpr (lanes == 4)
      return reinterpret_cast<Numbers>(_mm256_permute4x64_epi64(
          _mm256_castps_si256(_mm256_shuffle_ps(reinterpret_cast<__m256>(first),
                                                reinterpret_cast<__m256>(second), 0x88)),
          0xD8));
#endif
    Numbers found;
    auto const low = numbers_of<Number>(first), high = numbers_of<Number>(second);
    std::memcpy(&found, &low, sizeof low);
    std::memcpy(reinterpret_cast<char*>(&found) + sizeof low, &high, sizeof high);
    return found;
  }

  /// Words of a register of columns, for two counters.
  struct Kept {
    std::uint64_t column = ~std::uint64_t{0}, counter = 0;  // `counter`: half of the two
    Philox<lanes> random[2] = {{0, 0}, {0, 0}};
  };
  struct AllKept {
    Kept of[most_registers][Bits::counters / 2];
  };
  struct Nothing {};

  void draw(Kept& kept, std::uint64_t column, std::uint64_t half) const {
    auto even = Philox<lanes>::with_equal_counters(2 * half, draw_),
         odd = Philox<lanes>::with_equal_counters(2 * half + 1, draw_);
    encrypt_with_keys(seed_ + column, even, odd);
    kept = {column, half, {even, odd}};
  }

  std::uint64_t seed_ = 0, draw_ = 0;
  mutable std::conditional_t<Keeps, AllKept, Nothing> kept_;
};

/// Random bits for replicas: replica r gets the bits of a RandomBits with the seed seed + r.
template <bool OnHost>
class RandomBitsOfReplica {
 public:
  RandomBitsOfReplica() = default;
  RandomBitsOfReplica(std::uint64_t seed, std::uint64_t draw)
      : seed_(seed), draw_(draw), bits_(seed, draw) {}

  template <class Number, int Lanes>
  KOKKOS_FORCEINLINE_FUNCTION typename LanesOf<Number, Lanes>::type get(std::int32_t replica,
                                                                        std::uint64_t place) const {
    if constexpr (OnHost) {
      if (replica != replica_) [[unlikely]] {
        bits_ = RandomBits<true>(seed_ + static_cast<std::uint64_t>(replica), draw_);
        replica_ = replica;
      }
      return bits_.template get<Number, Lanes>(place);
    } else {
      if (replica == 0) return bits_.template get<Number, Lanes>(place);
      return RandomBits<false>(seed_ + static_cast<std::uint64_t>(replica), draw_)
          .template get<Number, Lanes>(place);
    }
  }

 private:
  std::uint64_t seed_ = 0, draw_ = 0;
  mutable std::int32_t replica_ = 0;  // the replica that bits_ is for
  mutable RandomBits<OnHost> bits_;
};

}  // namespace cayspin::inline v0_2::detail
