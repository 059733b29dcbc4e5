// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>

// Reductions of float fields work on packs of double: half a register of floats, converted at once.
namespace cayspin::inline v0_1::detail {

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

}  // namespace cayspin::inline v0_1::detail
