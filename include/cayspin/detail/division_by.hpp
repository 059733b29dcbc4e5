// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Macros.hpp>

#include <bit>
#include <cstdint>

namespace cayspin::inline v0_2::detail {

/// Divides whole numbers from 0 to 2^31 - 1 by a fixed divisor, with a multiplication and a shift
/// (Granlund and Montgomery 1994). On devices this takes a few instructions; an integer division
/// takes about forty.
struct DivisionBy {
  std::uint32_t multiplier = 0;
  std::int32_t shift = 31;

  /// By default, every quotient is 0.
  DivisionBy() = default;
  /// The divisor must be at least 1.
  explicit DivisionBy(std::int32_t divisor) {
    // 2^bits >= divisor. The multiplier is 2^(31 + bits) / divisor, rounded up. It is less than
    // 2^32, and rounding has increased it by less than 2^bits / divisor.
    auto const d = static_cast<std::uint32_t>(divisor);
    auto const bits = static_cast<int>(std::bit_width(d - 1));
    shift = 31 + bits;
    multiplier = static_cast<std::uint32_t>(((std::uint64_t(1) << shift) + d - 1) / d);
  }

  KOKKOS_FORCEINLINE_FUNCTION std::int32_t quotient(std::int32_t number) const {
    std::uint64_t const product = std::uint64_t(static_cast<std::uint32_t>(number)) * multiplier;
    return static_cast<std::int32_t>(product >> shift);
  }
};

}  // namespace cayspin::inline v0_2::detail
