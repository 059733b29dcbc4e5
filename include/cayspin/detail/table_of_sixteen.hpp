// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>

#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// True if the entries for a register of Numbers can be looked up, in a table of sixteen, by one or
/// two instructions.
template <class Numbers>
#if defined(CAYSPIN_DETAIL_AVX512_OF_INTEGERS)
inline constexpr bool has_table_of_sixteen = sizeof(Numbers) == 64;
#else
inline constexpr bool has_table_of_sixteen = false;
#endif

#if defined(CAYSPIN_DETAIL_AVX512_OF_INTEGERS)
/// Returns the bits of table[code % 16] for each code.
template <class Real, class Numbers>
KOKKOS_FORCEINLINE_FUNCTION Numbers look_up(Real const (&table)[16], Numbers const& code) {
  static_assert(has_table_of_sixteen<Numbers>);
  auto const at = reinterpret_cast<__m512i>(code);
  if constexpr (sizeof(Real) == 8)
    return reinterpret_cast<Numbers>(
        _mm512_permutex2var_pd(_mm512_loadu_pd(table), at, _mm512_loadu_pd(table + 8)));
  else
    return reinterpret_cast<Numbers>(_mm512_permutexvar_ps(at, _mm512_loadu_ps(table)));
}
#else
template <class Real, class Numbers>
void look_up(Real const (&table)[16], Numbers const& code) = delete;
#endif

}  // namespace cayspin::inline v0_2::detail
