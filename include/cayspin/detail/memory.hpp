// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/pack.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#if defined(__linux__)
#include <sys/mman.h>
#include <unistd.h>
#endif

// Loads and stores of packs, and what depends on the operating system: huge pages and the sizes of
// the caches.
namespace cayspin::inline v0_2::detail {

template <class Value, class Real>
KOKKOS_FORCEINLINE_FUNCTION Value load(Real const* from) {
  if constexpr (std::is_floating_point_v<Value>) {
    return static_cast<Value>(*from);
  } else if constexpr (std::is_same_v<scalar_t<Value>, Real>) {
#if KOKKOS_VERSION >= 50000
    return Value(from, Kokkos::Experimental::simd_flag_default);
#else
    Value value;
    value.copy_from(from, Kokkos::Experimental::simd_flag_default);
    return value;
#endif
  } else {
    return Value([from](auto lane) { return static_cast<scalar_t<Value>>(from[lane()]); });
  }
}

/// Refuses double values at sites of float spins: rows of the two precisions have other strides.
template <class Value, class Real>
constexpr void check_precision() {
  static_assert(sizeof(Real) <= sizeof(scalar_t<Value>),
                "A field that a term loads has the precision of the spins.");
}

// Loads half a register of floats into a pack of doubles, by one instruction that converts.
// Reductions of float fields use this.
#if defined(CAYSPIN_DETAIL_AVX512)
template <>
KOKKOS_FORCEINLINE_FUNCTION Pack<double> load<Pack<double>, float>(float const* from) {
  return Pack<double>(_mm512_maskz_cvtps_pd(0xff, _mm256_loadu_ps(from)));
}
#elif defined(CAYSPIN_DETAIL_AVX2)
template <>
KOKKOS_FORCEINLINE_FUNCTION Pack<double> load<Pack<double>, float>(float const* from) {
  return Pack<double>(_mm256_cvtps_pd(_mm_loadu_ps(from)));
}
#endif

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION void store(Value const& value, scalar_t<Value>* to) {
  if constexpr (std::is_floating_point_v<Value>) {
    *to = value;
  } else {
#if KOKKOS_VERSION >= 50000
    Kokkos::Experimental::simd_unchecked_store(value, to, Kokkos::Experimental::simd_flag_default);
#else
    value.copy_to(to, Kokkos::Experimental::simd_flag_default);
#endif
  }
}

/// Returns its argument, but hides from the compiler how it was computed. The compiler then
/// computes addresses where they are used, and does not keep more of them than there are registers.
template <class Word>
KOKKOS_FORCEINLINE_FUNCTION Word opaque(Word word) {
#if defined(CAYSPIN_DETAIL_GNU) && defined(CAYSPIN_DETAIL_X86)
  __asm__("" : "+r"(word));
#endif
  return word;
}

/// Writes a pack to memory, bypassing the caches where the processor can. `to` must be aligned to
/// the size of the pack.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION void store_streaming(Value const& value, scalar_t<Value>* to) {
#if defined(CAYSPIN_DETAIL_AVX512)
  if constexpr (std::is_same_v<Value, Pack<double>>) {
    _mm512_stream_pd(to, static_cast<__m512d>(value));
    return;
  } else if constexpr (std::is_same_v<Value, Pack<float>>) {
    _mm512_stream_ps(to, static_cast<__m512>(value));
    return;
  }
#elif defined(CAYSPIN_DETAIL_AVX2)
  if constexpr (std::is_same_v<Value, Pack<double>>) {
    _mm256_stream_pd(to, static_cast<__m256d>(value));
    return;
  } else if constexpr (std::is_same_v<Value, Pack<float>>) {
    _mm256_stream_ps(to, static_cast<__m256>(value));
    return;
  }
#endif
  store(value, to);
}

/// Prefetches a cache line that will be read about a row later; the address need not be valid.
KOKKOS_FORCEINLINE_FUNCTION void prefetch([[maybe_unused]] void const* address) {
#if defined(CAYSPIN_DETAIL_GNU)
  __builtin_prefetch(address);
#endif
}

/// Orders this thread's streaming stores before its later stores.
inline void streaming_fence() {
#if defined(CAYSPIN_DETAIL_X86)
  _mm_sfence();
#endif
}

/// A common size of the last-level cache, assumed when the system reports none.
inline constexpr std::size_t usual_cache_bytes = std::size_t(32) << 20;

/// Returns how many bytes of the last-level cache one process can expect to use: all of a cache of
/// up to usual_cache_bytes; of a larger one, which many cores share, a third, but not less than
/// usual_cache_bytes.
inline std::size_t last_level_cache_bytes() {
#if defined(__linux__) && defined(_SC_LEVEL3_CACHE_SIZE)
  static std::size_t const bytes = [] {
    long const reported = sysconf(_SC_LEVEL3_CACHE_SIZE);
    if (reported <= 0) return usual_cache_bytes;
    auto const all = static_cast<std::size_t>(reported);
    return all <= usual_cache_bytes ? all : std::max(usual_cache_bytes, all / 3);
  }();
  return bytes;
#else
  return usual_cache_bytes;
#endif
}

/// Returns the size of a core's level-2 cache in bytes; 1 MiB if the system does not report it.
inline std::size_t core_cache_bytes() {
  static constexpr std::size_t usual = std::size_t(1) << 20;
#if defined(__linux__) && defined(_SC_LEVEL2_CACHE_SIZE)
  static std::size_t const bytes = [] {
    long const reported = sysconf(_SC_LEVEL2_CACHE_SIZE);
    return reported > 0 ? static_cast<std::size_t>(reported) : usual;
  }();
  return bytes;
#else
  return usual;
#endif
}

/// Returns true if a method with a working set of this many bytes should bypass the caches when it
/// stores. On devices it never should.
template <class Exec>
bool exceeds_caches(std::size_t bytes) {
  if constexpr (std::is_same_v<typename Exec::memory_space, Kokkos::HostSpace>)
    return bytes > last_level_cache_bytes();
  else
    return false;
}

/// Requests 2 MiB pages inside [begin, begin + bytes); call before the memory is first touched.
inline void advise_huge_pages([[maybe_unused]] void* begin, [[maybe_unused]] std::size_t bytes) {
#if defined(__linux__)
  constexpr std::uintptr_t page = std::uintptr_t(2) << 20;
  auto const address = reinterpret_cast<std::uintptr_t>(begin);
  std::uintptr_t const first = (address + page - 1) / page * page;
  std::uintptr_t const last = (address + bytes) / page * page;
  if (first < last) madvise(reinterpret_cast<void*>(first), last - first, MADV_HUGEPAGE);
#endif
}

}  // namespace cayspin::inline v0_2::detail
