// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/stage/update.hpp>

#include <array>

namespace cayspin::inline v0_2 {

namespace update {

/// Update with compensated sums: the rounding error at the end of a step is added to the next step.
template <class Update>
struct Compensated : Update {
  static constexpr std::array carried{"residual"};  // fields that a step leaves for the next
  static constexpr bool recovers_increments(int) { return false; }  // inaccurate from rounded spins
};

}  // namespace update

namespace detail {

/// Returns the number of fields that the last stage of a step leaves for the last stage of the next
/// step.
template <class Update>
constexpr int carried_fields() {
  if constexpr (requires { Update::carried; }) return static_cast<int>(Update::carried.size());
  return 0;
}

/// The update without compensation, for all stages but the last.
template <class Update>
struct PlainUpdate {
  using type = Update;
};
template <class Update>
struct PlainUpdate<update::Compensated<Update>> {
  using type = Update;
};

/// A vector as an unevaluated sum: the rounded sum and its rounding error.
template <class Value>
struct RoundedSum {
  Vec3<Value> sum, residual;
};

/// Returns a + b and its rounding error. Either of a and b may be the larger (Knuth 1969).
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION RoundedSum<Value> rounded_sum(Vec3<Value> const& a,
                                                          Vec3<Value> const& b) {
  Vec3<Value> const sum = a + b;
  Vec3<Value> const added = sum - a;
  return {sum, (a - (sum - added)) + (b - added)};
}

}  // namespace detail
}  // namespace cayspin::inline v0_2
