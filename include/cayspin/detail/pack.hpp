// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/backend.hpp>

#include <Kokkos_BitManipulation.hpp>
#include <Kokkos_Core.hpp>
#include <Kokkos_SIMD.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#if defined(CAYSPIN_DETAIL_X86)
#include <immintrin.h>
#endif

// A Pack is the value type of one iteration of a host loop: a register of Kokkos' SIMD types where
// the configured architecture has one (backend.hpp), otherwise one number. Device loops use single
// numbers, and in device passes of the compiler a Pack is a single number, too. So that all passes
// agree on the types of kernels, no kernel has a pack in its template arguments or parameters. The
// operations here accept packs and numbers, so that kernels are written once.
namespace cayspin::inline v0_2::detail {

#if defined(CAYSPIN_DETAIL_SIMD_ABI)
template <std::floating_point Real>
inline constexpr int host_lanes = CAYSPIN_DETAIL_REGISTER_BYTES / static_cast<int>(sizeof(Real));
#if KOKKOS_VERSION >= 40600
template <std::floating_point Real, int Lanes>
using Simd = Kokkos::Experimental::basic_simd<
    Real, Kokkos::Experimental::simd_abi::CAYSPIN_DETAIL_SIMD_ABI<Lanes>>;
#else
template <std::floating_point Real, int Lanes>
using Simd =
    Kokkos::Experimental::simd<Real,
                               Kokkos::Experimental::simd_abi::CAYSPIN_DETAIL_SIMD_ABI<Lanes>>;
#endif
template <std::floating_point Real>
using Pack = Simd<Real, host_lanes<Real>>;
#undef CAYSPIN_DETAIL_SIMD_ABI
#else
template <std::floating_point Real>
inline constexpr int host_lanes = 1;
template <std::floating_point Real>
using Pack = Real;
#endif

template <class Value>
struct ValueTraits {
  using scalar = typename Value::value_type;
  using mask = typename Value::mask_type;
  static constexpr int lanes = static_cast<int>(Value::size());
};
template <std::floating_point Value>
struct ValueTraits<Value> {
  using scalar = Value;
  using mask = bool;
  static constexpr int lanes = 1;
};
template <class Value>
using scalar_t = typename ValueTraits<Value>::scalar;
template <class Value>
inline constexpr int lanes_of = ValueTraits<Value>::lanes;

/// True if a Value belongs to a single site, as on devices. Code can then branch, and evaluate only
/// the formula that this site needs.
template <class Value>
inline constexpr bool one_at_a_time = lanes_of<Value> == 1;

/// Returns a * b + c, rounded only once where the hardware can do so.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value multiply_add(Value const& a, Value const& b, Value const& c) {
  if constexpr (std::is_floating_point_v<Value>) {
#if defined(CAYSPIN_DETAIL_FMA)
    return Kokkos::fma(a, b, c);
#else
    return a * b + c;  // Kokkos::fma would be a slow library call here
#endif
  } else {
    return Kokkos::fma(a, b, c);
  }
}

/// Returns a * b - c, rounded only once where the hardware can do so. Uses intrinsics, because
/// Kokkos' packs negate c in a separate instruction.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value multiply_subtract(Value const& a, Value const& b,
                                                    Value const& c) {
#if defined(CAYSPIN_DETAIL_AVX512)
  if constexpr (std::is_same_v<Value, Pack<double>>) {
    return Value(
        _mm512_fmsub_pd(static_cast<__m512d>(a), static_cast<__m512d>(b), static_cast<__m512d>(c)));
  } else if constexpr (std::is_same_v<Value, Pack<float>>) {
    return Value(
        _mm512_fmsub_ps(static_cast<__m512>(a), static_cast<__m512>(b), static_cast<__m512>(c)));
  }
#elif defined(CAYSPIN_DETAIL_AVX2)
  if constexpr (std::is_same_v<Value, Pack<double>>) {
    return Value(
        _mm256_fmsub_pd(static_cast<__m256d>(a), static_cast<__m256d>(b), static_cast<__m256d>(c)));
  } else if constexpr (std::is_same_v<Value, Pack<float>>) {
    return Value(
        _mm256_fmsub_ps(static_cast<__m256>(a), static_cast<__m256>(b), static_cast<__m256>(c)));
  }
#endif
  return multiply_add(a, b, Value(-c));
}

/// Returns `yes` in lanes where the condition holds, and `no` in the others. Form conditions only
/// with < and ==: in Kokkos 4.7 the > and >= of 512-bit double packs compare the wrong way round,
/// and != is false for NaN.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value select(typename ValueTraits<Value>::mask const& condition,
                                         Value const& yes, Value const& no) {
  if constexpr (std::is_floating_point_v<Value>) {
    return condition ? yes : no;
  } else {
    return Kokkos::Experimental::condition(condition, yes, no);
  }
}

/// Returns the square root. For packs of 512 bits it does not use Kokkos' root, because g++ 12
/// reports an uninitialised variable in the intrinsic that Kokkos uses.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value square_root(Value const& a) {
#if defined(CAYSPIN_DETAIL_AVX512)
  if constexpr (std::is_same_v<Value, Pack<double>>) {
    return Value(_mm512_maskz_sqrt_pd(0xff, static_cast<__m512d>(a)));
  } else if constexpr (std::is_same_v<Value, Pack<float>>) {
    return Value(_mm512_maskz_sqrt_ps(0xffff, static_cast<__m512>(a)));
  }
#endif
  return Kokkos::sqrt(a);
}

/// Returns the whole number nearest to a, if |a| is below 2^51 for double and 2^22 for float;
/// beyond that, a number nearby.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value nearest(Value const& a) {
  Value const shift(sizeof(scalar_t<Value>) == sizeof(double)
                        ? static_cast<scalar_t<Value>>(0x1.8p52)
                        : static_cast<scalar_t<Value>>(0x1.8p23));
  return (a + shift) - shift;
}

/// Returns the maximum of a and b, and `a` where either is NaN.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value maximum(Value const& a, Value const& b) {
#if defined(CAYSPIN_DETAIL_MAXIMUM_IS_SECOND)
  if constexpr (lanes_of<Value> > 1) return Kokkos::max(b, a);  // `a` where either is NaN
#endif
  return select<Value>(a < b, b, a);
}

/// Returns 2^k for a whole number k. 2^k must be a normal number.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value power_of_two(Value const& k) {
  if constexpr (std::is_floating_point_v<Value>) {
    if constexpr (sizeof(Value) == sizeof(double))
      return Kokkos::bit_cast<double>((static_cast<std::int64_t>(k) + 1023) << 52);
    else
      return Kokkos::bit_cast<float>((static_cast<std::int32_t>(k) + 127) << 23);
  } else {
#if defined(CAYSPIN_DETAIL_AVX512)
    if constexpr (std::is_same_v<Value, Pack<double>>) {
      return Value(_mm512_maskz_scalef_pd(0xff, _mm512_set1_pd(1), static_cast<__m512d>(k)));
    } else if constexpr (std::is_same_v<Value, Pack<float>>) {
      return Value(_mm512_maskz_scalef_ps(0xffff, _mm512_set1_ps(1), static_cast<__m512>(k)));
    }
#endif
    return Value([&](auto lane) { return power_of_two<scalar_t<Value>>(k[lane()]); });
  }
}

/// Returns true if a condition holds in all lanes.
template <class Mask>
KOKKOS_FORCEINLINE_FUNCTION bool holds_everywhere(Mask const& mask) {
  if constexpr (std::is_same_v<Mask, bool>)
    return mask;
  else
    return Kokkos::Experimental::all_of(mask);
}

/// Returns 0, 1, 2, ... in the lanes.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value lane_numbers() {
  if constexpr (std::is_floating_point_v<Value>) {
    return Value(0);
  } else {
    return Value([](auto lane) { return static_cast<scalar_t<Value>>(lane()); });
  }
}

}  // namespace cayspin::inline v0_2::detail
