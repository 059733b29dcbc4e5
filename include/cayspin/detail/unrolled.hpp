// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Macros.hpp>

#include <type_traits>
#include <utility>

namespace cayspin::inline v0_2::detail {

template <int... I, class Body>
KOKKOS_FORCEINLINE_FUNCTION void unrolled(std::integer_sequence<int, I...>, Body const& body) {
  (body(std::integral_constant<int, I>{}), ...);
}

/// Calls body(i) for i = 0 .. Count - 1, with i a compile-time constant.
template <int Count, class Body>
KOKKOS_FORCEINLINE_FUNCTION void unrolled(Body const& body) {
  unrolled(std::make_integer_sequence<int, Count>{}, body);
}

}  // namespace cayspin::inline v0_2::detail
