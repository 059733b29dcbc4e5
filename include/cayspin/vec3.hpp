// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/pack.hpp>

namespace cayspin {

/// Three components; Value is float, double, or a pack of either (several sites at once).
template <class Value>
struct Vec3 {
  using value_type = Value;
  Value x, y, z;

  friend KOKKOS_FORCEINLINE_FUNCTION Vec3 operator+(Vec3 const& a, Vec3 const& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend KOKKOS_FORCEINLINE_FUNCTION Vec3 operator-(Vec3 const& a, Vec3 const& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend KOKKOS_FORCEINLINE_FUNCTION Vec3 operator*(Value const& s, Vec3 const& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
};

/// s a + b
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> multiply_add(Value const& s, Vec3<Value> const& a,
                                                     Vec3<Value> const& b) {
  return {detail::multiply_add(s, a.x, b.x), detail::multiply_add(s, a.y, b.y),
          detail::multiply_add(s, a.z, b.z)};
}

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value dot(Vec3<Value> const& a, Vec3<Value> const& b) {
  return detail::multiply_add(a.x, b.x, detail::multiply_add(a.y, b.y, a.z * b.z));
}

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> cross(Vec3<Value> const& a, Vec3<Value> const& b) {
  return {detail::multiply_subtract(a.y, b.z, Value(a.z * b.y)),
          detail::multiply_subtract(a.z, b.x, Value(a.x * b.z)),
          detail::multiply_subtract(a.x, b.y, Value(a.y * b.x))};
}

namespace detail {

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> select(typename ValueTraits<Value>::mask const& condition,
                                               Vec3<Value> const& yes, Vec3<Value> const& no) {
  return {select<Value>(condition, yes.x, no.x), select<Value>(condition, yes.y, no.y),
          select<Value>(condition, yes.z, no.z)};
}

}  // namespace detail
}  // namespace cayspin
