// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/pack.hpp>

#include <cmath>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace cayspin::inline v0_2 {

/// Three components. Value is float, double, or a pack of either: on the host one value holds the
/// numbers of several sites. Numbers of another type (2.0 * v, v * 2) are first converted to the
/// scalar of Value.
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
  friend KOKKOS_FORCEINLINE_FUNCTION Vec3 operator-(Vec3 const& a) { return {-a.x, -a.y, -a.z}; }

  friend KOKKOS_FORCEINLINE_FUNCTION Vec3 operator*(Value const& s, Vec3 const& a) {
    return {s * a.x, s * a.y, s * a.z};
  }
  friend KOKKOS_FORCEINLINE_FUNCTION Vec3 operator*(Vec3 const& a, Value const& s) { return s * a; }
  template <class Number>
  friend KOKKOS_FORCEINLINE_FUNCTION Vec3 operator*(Number s, Vec3 const& a)
    requires(std::is_arithmetic_v<Number> && !std::is_same_v<Number, Value>)
  {
    return Value(static_cast<detail::scalar_t<Value>>(s)) * a;
  }
  template <class Number>
  friend KOKKOS_FORCEINLINE_FUNCTION Vec3 operator*(Vec3 const& a, Number s)
    requires(std::is_arithmetic_v<Number> && !std::is_same_v<Number, Value>)
  {
    return Value(static_cast<detail::scalar_t<Value>>(s)) * a;
  }

  KOKKOS_FORCEINLINE_FUNCTION Vec3& operator+=(Vec3 const& a) { return *this = *this + a; }
  KOKKOS_FORCEINLINE_FUNCTION Vec3& operator-=(Vec3 const& a) { return *this = *this - a; }
};

/// Short names for use in terms: the value type of a stencil, a spin or a site, and the type of its
/// vectors.
template <class Stencil>
using ValueOf = typename Stencil::value_type;
template <class Stencil>
using VectorOf = Vec3<typename Stencil::value_type>;

/// Returns s * a + b.
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

/// Returns the zero vector.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> zero() {
  return {Value(0), Value(0), Value(0)};
}

/// Returns a number as a kernel's value type.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value as_value(double number) {
  return Value(static_cast<detail::scalar_t<Value>>(number));
}

/// Returns the components of v as kernel values.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> as_value(Vec3<double> const& v) {
  return {as_value<Value>(v.x), as_value<Value>(v.y), as_value<Value>(v.z)};
}

/// Returns `axis` divided by its length. Throws std::invalid_argument if the length is zero or not
/// finite; the message starts with `what`.
inline Vec3<double> normalized(Vec3<double> const& axis, char const* what) {
  double const length = std::hypot(axis.x, axis.y, axis.z);
  if (!(length > 0) || !std::isfinite(length))
    throw std::invalid_argument(std::string(what) + " must be finite and not zero");
  return {axis.x / length, axis.y / length, axis.z / length};
}

namespace detail {

/// Returns the argument; throws std::invalid_argument when it is not finite.
inline double finite(double number, char const* what) {
  if (!std::isfinite(number)) throw std::invalid_argument(std::string(what) + " must be finite");
  return number;
}
inline Vec3<double> finite(Vec3<double> const& v, char const* what) {
  return {finite(v.x, what), finite(v.y, what), finite(v.z, what)};
}

/// Squares of lengths below this are too inaccurate to divide by.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION constexpr scalar_t<Value> smallest_square() {
  using Scalar = scalar_t<Value>;
  return sizeof(Scalar) == sizeof(double) ? static_cast<Scalar>(0x1p-970)
                                          : static_cast<Scalar>(0x1p-103);
}

/// Returns |m|^2, or smallest_square if that is larger, to divide by: for the zero spin of a vacant
/// site, 0 divided by the result is 0. NaN stays NaN.
template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Value square_to_divide_by(Vec3<Value> const& m) {
  return maximum<Value>(dot(m, m), Value(smallest_square<Value>()));
}

template <class Value>
KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> select(typename ValueTraits<Value>::mask const& condition,
                                               Vec3<Value> const& yes, Vec3<Value> const& no) {
  return {select<Value>(condition, yes.x, no.x), select<Value>(condition, yes.y, no.y),
          select<Value>(condition, yes.z, no.z)};
}

}  // namespace detail

/// select<Value>(condition, yes, no) is `yes` at the sites where the condition holds, and `no`
/// elsewhere; both are numbers, or both are vectors. Use it in kernels instead of `if`, since a
/// pack of sites may need both. Write conditions only with < and ==, for example
/// select<Value>(Value(0) < m.z, a, b). Kokkos 4.7 compares 512-bit packs of doubles the wrong way
/// round with > and >=.
using detail::select;

}  // namespace cayspin::inline v0_2
