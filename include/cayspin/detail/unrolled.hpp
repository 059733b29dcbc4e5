// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <Kokkos_Macros.hpp>

#include <type_traits>
#include <utility>

namespace cayspin::inline v0_1::detail {

template <int... I, class Body>
KOKKOS_FORCEINLINE_FUNCTION void unrolled(std::integer_sequence<int, I...>, Body const& body) {
  (body(std::integral_constant<int, I>{}), ...);
}

/// Calls body(i) for i = 0 .. Count - 1, each known when compiled.
template <int Count, class Body>
KOKKOS_FORCEINLINE_FUNCTION void unrolled(Body const& body) {
  unrolled(std::make_integer_sequence<int, Count>{}, body);
}

template <int N, int K>
inline constexpr int binomial = K == 0 ? 1 : binomial<N - 1, K - 1> * N / K;
template <int N>
inline constexpr int binomial<N, 0> = 1;

/// Leibniz' rule: calls term(binomial(K, j), j, K - j) for j = 0 .. K, all known when compiled.
template <int K, class Term>
KOKKOS_FORCEINLINE_FUNCTION void leibniz(Term const& term) {
  unrolled<K + 1>([&](auto j) {
    term(std::integral_constant<int, binomial<K, j()>>{}, j,
         std::integral_constant<int, K - j()>{});
  });
}

}  // namespace cayspin::inline v0_1::detail
