// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Core.hpp>

#include <cstddef>
#include <cstdint>

// Macros that describe the compiler, the processor, and whether code is compiled for a host or a
// device. Other headers test them. execution.hpp has the differences between host spaces.

// Defined in compiler passes that generate device code.
#if defined(__CUDA_ARCH__) || defined(__HIP_DEVICE_COMPILE__) || defined(__SYCL_DEVICE_ONLY__)
#define CAYSPIN_DETAIL_DEVICE_PASS
#endif

// SIMD registers of the host. No device pass sees them, because nvcc rejects host SIMD types in
// `__host__ __device__` functions.
#if defined(CAYSPIN_DETAIL_DEVICE_PASS)
// no pack type
#elif defined(KOKKOS_ARCH_AVX512XEON)
#define CAYSPIN_DETAIL_AVX512
#define CAYSPIN_DETAIL_SIMD_ABI avx512_fixed_size
#define CAYSPIN_DETAIL_REGISTER_BYTES 64
#elif defined(KOKKOS_ARCH_AVX2)
#define CAYSPIN_DETAIL_AVX2
#define CAYSPIN_DETAIL_SIMD_ABI avx2_fixed_size
#define CAYSPIN_DETAIL_REGISTER_BYTES 32
#elif defined(KOKKOS_ARCH_ARM_NEON)
#define CAYSPIN_DETAIL_SIMD_ABI neon_fixed_size
#define CAYSPIN_DETAIL_REGISTER_BYTES 16
#endif

// Intrinsics on GNU vectors of integers, which nvcc does not parse.
#if defined(CAYSPIN_DETAIL_AVX512) && !defined(__CUDACC__)
#define CAYSPIN_DETAIL_AVX512_OF_INTEGERS
#elif defined(CAYSPIN_DETAIL_AVX2) && !defined(__CUDACC__)
#define CAYSPIN_DETAIL_AVX2_OF_INTEGERS
#endif

// x86-64 instructions that no pack type provides, for example _mm_sfence and _mm_pause.
#if defined(__x86_64__) && !defined(CAYSPIN_DETAIL_DEVICE_PASS)
#define CAYSPIN_DETAIL_X86
#endif

// g++ and clang extensions: inline assembly, prefetches.
#if defined(__GNUC__) && !defined(CAYSPIN_DETAIL_DEVICE_PASS)
#define CAYSPIN_DETAIL_GNU
#endif

// Defined where a * b + c is a single instruction.
#if defined(__FMA__) || defined(__ARM_FEATURE_FMA) || defined(CAYSPIN_DETAIL_DEVICE_PASS)
#define CAYSPIN_DETAIL_FMA
#endif

// Defined if Kokkos::max(a, b) of two packs returns b in each lane where either is NaN.
#if defined(__AVX2__)
#define CAYSPIN_DETAIL_MAXIMUM_IS_SECOND
#endif

#if defined(__GNUC__)
#define CAYSPIN_DETAIL_NOINLINE [[gnu::noinline]]
#else
#define CAYSPIN_DETAIL_NOINLINE
#endif

// Marks a member that needs no unique address. nvcc 13.0 lays out a class with such a member
// differently in device and host code, so that device code reads the wrong place. With CUDA the
// attribute is therefore left out.
#if defined(KOKKOS_ENABLE_CUDA)
#define CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS
#else
#define CAYSPIN_DETAIL_NO_UNIQUE_ADDRESS [[no_unique_address]]
#endif

// Precedes a loop whose iterations are independent.
#if defined(CAYSPIN_DETAIL_DEVICE_PASS)
#define CAYSPIN_DETAIL_INDEPENDENT
#elif defined(__clang__)
#define CAYSPIN_DETAIL_INDEPENDENT _Pragma("clang loop vectorize(assume_safety)")
#elif defined(__GNUC__)
#define CAYSPIN_DETAIL_INDEPENDENT _Pragma("GCC ivdep")
#else
#define CAYSPIN_DETAIL_INDEPENDENT
#endif

// Precedes a loop that must not be unrolled.
#if defined(__GNUC__) && !defined(__clang__) && !defined(__CUDACC__)
#define CAYSPIN_DETAIL_NOT_UNROLLED _Pragma("GCC unroll 1")
#else
#define CAYSPIN_DETAIL_NOT_UNROLLED
#endif

namespace cayspin::inline v0_2::detail {

inline constexpr std::int64_t cache_line_bytes = 64, page_bytes = 4096;

/// Number of device threads that share a tile of rows: on most devices, one thread block of Kokkos.
inline constexpr std::uint32_t threads_of_tile = 128;

// Returns 1 / number to at least 18 bits. Defined only in CUDA device code, where division is slow.
#if defined(__CUDA_ARCH__)
#define CAYSPIN_DETAIL_ROUGH_INVERSE
__device__ __forceinline__ double rough_inverse(double number) {
  double inverse;
  asm("rcp.approx.ftz.f64 %0, %1;" : "=d"(inverse) : "d"(number));  // to 18 bits
  return inverse;
}
__device__ __forceinline__ float rough_inverse(float number) {
  float inverse;
  asm("rcp.approx.ftz.f32 %0, %1;" : "=f"(inverse) : "f"(number));  // to 23 bits
  return inverse;
}
#endif

}  // namespace cayspin::inline v0_2::detail
