// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>

#include <cstddef>
#include <cstdint>

// Loads and stores of packs whose numbers are two apart in memory.
namespace cayspin::inline v0_2::detail {

/// Returns from[Odd], from[Odd + 2], ...; may read two whole packs, which start at `from`.
template <int Odd, class Value, class Real>
KOKKOS_FORCEINLINE_FUNCTION Value load_every_other(Real const* from) {
  if constexpr (std::is_same_v<scalar_t<Value>, Real>) {
#if defined(CAYSPIN_DETAIL_AVX512)
    if constexpr (std::is_same_v<Value, Pack<double>>) {
      __m512i const picked =
          _mm512_setr_epi64(Odd, Odd + 2, Odd + 4, Odd + 6, Odd + 8, Odd + 10, Odd + 12, Odd + 14);
      return Value(
          _mm512_permutex2var_pd(_mm512_loadu_pd(from), picked, _mm512_loadu_pd(from + 8)));
    } else if constexpr (std::is_same_v<Value, Pack<float>>) {
      __m512i const picked = _mm512_setr_epi32(Odd, Odd + 2, Odd + 4, Odd + 6, Odd + 8, Odd + 10,
                                               Odd + 12, Odd + 14, Odd + 16, Odd + 18, Odd + 20,
                                               Odd + 22, Odd + 24, Odd + 26, Odd + 28, Odd + 30);
      return Value(
          _mm512_permutex2var_ps(_mm512_loadu_ps(from), picked, _mm512_loadu_ps(from + 16)));
    }
#elif defined(CAYSPIN_DETAIL_AVX2)
    if constexpr (std::is_same_v<Value, Pack<double>>) {
      __m256d const low = _mm256_loadu_pd(from), high = _mm256_loadu_pd(from + 4);
      return Value(_mm256_permute4x64_pd(
          Odd == 0 ? _mm256_unpacklo_pd(low, high) : _mm256_unpackhi_pd(low, high), 0xd8));
    } else if constexpr (std::is_same_v<Value, Pack<float>>) {
      __m256 const low = _mm256_loadu_ps(from), high = _mm256_loadu_ps(from + 8);
      __m256 const mixed = _mm256_shuffle_ps(low, high, Odd == 0 ? 0x88 : 0xdd);
      return Value(_mm256_castpd_ps(_mm256_permute4x64_pd(_mm256_castps_pd(mixed), 0xd8)));
    }
#endif
  }
  return Value([from](auto lane) { return static_cast<scalar_t<Value>>(from[2 * lane() + Odd]); });
}

/// Returns from[0], from[2], ... in lanes whose index into `from` is in first .. last, and loads
/// nothing else. The other lanes are unspecified.
template <class Value, class Real>
KOKKOS_FORCEINLINE_FUNCTION Value load_every_other_of(Real const* from, std::int32_t first,
                                                      std::int32_t last) {
  constexpr std::int32_t lanes = lanes_of<Value>;
#if defined(CAYSPIN_DETAIL_AVX512)
  std::uint32_t const to_last = last < 0 ? 0u : last < 31 ? (2u << last) - 1 : ~0u;
  std::uint32_t const wanted = 0x55555555u & to_last & (~0u << first);
  if constexpr (std::is_same_v<Value, Pack<double>> && std::is_same_v<Real, double>) {
    __m512i const picked = _mm512_setr_epi64(0, 2, 4, 6, 8, 10, 12, 14);
    return Value(_mm512_permutex2var_pd(
        _mm512_maskz_loadu_pd(static_cast<__mmask8>(wanted), from), picked,
        _mm512_maskz_loadu_pd(static_cast<__mmask8>(wanted >> 8), from + 8)));
  } else if constexpr (std::is_same_v<Value, Pack<float>> && std::is_same_v<Real, float>) {
    __m512i const picked =
        _mm512_setr_epi32(0, 2, 4, 6, 8, 10, 12, 14, 16, 18, 20, 22, 24, 26, 28, 30);
    return Value(_mm512_permutex2var_ps(
        _mm512_maskz_loadu_ps(static_cast<__mmask16>(wanted), from), picked,
        _mm512_maskz_loadu_ps(static_cast<__mmask16>(wanted >> 16), from + 16)));
  }
#endif
  scalar_t<Value> numbers[std::size_t{lanes}];
  for (std::int32_t lane = 0; lane < lanes; ++lane) {
    std::int32_t const index = 2 * lane;
    numbers[lane] = first <= index && index <= last ? static_cast<scalar_t<Value>>(from[index]) : 0;
  }
  return load<Value>(numbers);
}

/// Writes the first `count` lanes to to[0], to[2], ... and nothing else. The masked stores begin
/// one number before `to` so that they end with the last lane. Stores that reached further would
/// delay later loads of the memory after that lane.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION void store_every_other(Value const& value, scalar_t<Value>* to,
                                                   std::int32_t count) {
#if defined(CAYSPIN_DETAIL_AVX512)
  std::uint32_t const wanted = 0xaaaaaaaau & static_cast<std::uint32_t>((1ull << (2 * count)) - 1);
  if constexpr (std::is_same_v<Value, Pack<double>>) {
    __m512d const all = static_cast<__m512d>(value);
    __m512i const low = _mm512_setr_epi64(0, 0, 1, 1, 2, 2, 3, 3);
    __m512i const high = _mm512_setr_epi64(4, 4, 5, 5, 6, 6, 7, 7);
    _mm512_mask_storeu_pd(to - 1, static_cast<__mmask8>(wanted),
                          _mm512_permutex2var_pd(all, low, all));
    _mm512_mask_storeu_pd(to + 7, static_cast<__mmask8>(wanted >> 8),
                          _mm512_permutex2var_pd(all, high, all));
    return;
  } else if constexpr (std::is_same_v<Value, Pack<float>>) {
    __m512 const all = static_cast<__m512>(value);
    __m512i const low = _mm512_setr_epi32(0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7);
    __m512i const high =
        _mm512_setr_epi32(8, 8, 9, 9, 10, 10, 11, 11, 12, 12, 13, 13, 14, 14, 15, 15);
    _mm512_mask_storeu_ps(to - 1, static_cast<__mmask16>(wanted),
                          _mm512_permutex2var_ps(all, low, all));
    _mm512_mask_storeu_ps(to + 15, static_cast<__mmask16>(wanted >> 16),
                          _mm512_permutex2var_ps(all, high, all));
    return;
  }
#endif
  for (std::int32_t lane = 0; lane < count; ++lane)
    to[2 * lane] = value[static_cast<std::size_t>(lane)];
}

}  // namespace cayspin::inline v0_2::detail
