// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stage/update.hpp>

namespace cayspin {

namespace update {

/// As Update, with what rounding takes off the spins at the end of a step added to the next one.
template <class Update>
struct Compensated : Update {
  static constexpr bool is_compensated = true;
  static constexpr bool has_chart = false;  // increments come back from rounded spins too rough
};

}  // namespace update

namespace detail {

template <class Update>
inline constexpr bool is_compensated = requires {
  Update::is_compensated;
};

/// What stages before the last one may use in its place.
template <class Update>
struct PlainUpdate {
  using type = Update;
};
template <class Update>
struct PlainUpdate<update::Compensated<Update>> {
  using type = Update;
};

/// A vector as the sum of two of one precision.
template <class Value>
struct RoundedSum {
  Vec3<Value> sum, residual;
};

/// a + b, and what its rounding leaves over, whichever is larger (Knuth 1969).
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION RoundedSum<Value> rounded_sum(Vec3<Value> const& a,
                                                          Vec3<Value> const& b) {
  Vec3<Value> const sum = a + b;
  Vec3<Value> const added = sum - a;
  return {sum, (a - (sum - added)) + (b - added)};
}

}  // namespace detail
}  // namespace cayspin
