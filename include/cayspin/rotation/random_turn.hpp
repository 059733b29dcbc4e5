// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/table_of_sixteen.hpp>
#include <cayspin/vec3.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace cayspin::inline v0_1::detail {

/// m <- exp(v) m for a random v made of five bits. Of the 32 cases v is 0 in 12, +-2 s along one of
/// the axes in 12, and sqrt(2) s (+-1, +-1, +-1) in 8. These have the moments of normal numbers of
/// deviation s up to the fifth, which is all that a step of weak order 2 knows of them (Kloeden and
/// Platen 1992, Sec. 14.2).
template <class Real, bool OnHost>
class RandomTurn {
 public:
  using Bits = std::conditional_t<sizeof(Real) == 8, std::uint64_t, std::uint32_t>;

  RandomTurn() = default;
  /// s^2: the variance of each component.
  explicit RandomTurn(double variance) {
    double const half_axial = std::sqrt(variance), half_diagonal = std::sqrt(1.5 * variance);
    axial_ = static_cast<Real>(std::tan(half_axial));
    diagonal_ = static_cast<Real>(std::tan(half_diagonal) / std::sqrt(3.0));
    axial_factor_ = static_cast<Real>(2 * std::pow(std::cos(half_axial), 2));
    diagonal_factor_ = static_cast<Real>(2 * std::pow(std::cos(half_diagonal), 2));
    if constexpr (OnHost)
      for (std::size_t code = 0; code < 16; ++code) {
        auto const turn = computed<Real>(static_cast<Bits>(code));
        tables_.x[code] = turn.tangent.x;
        tables_.y[code] = turn.tangent.y;
        tables_.z[code] = turn.tangent.z;
        tables_.factor[code] = turn.factor;
      }
  }

  /// By the five bits from `First` on.
  template <int First, class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> turned(Numbers const& numbers,
                                                 Vec3<Value> const& m) const {
    auto const [b, factor] = turn_of<Value>(Numbers(numbers >> First));
    Vec3<Value> const half{plus_cross(m.x, b.y, m.z, b.z, m.y), plus_cross(m.y, b.z, m.x, b.x, m.z),
                           plus_cross(m.z, b.x, m.y, b.y, m.x)};
    return multiply_add(factor, cross(b, half), m);
  }

 private:
  /// exp(v) m = m + factor tangent x (m + tangent x m): tangent is tan(|v| / 2) v / |v|, and factor
  /// 2 cos^2(|v| / 2).
  template <class Value>
  struct Turn {
    Vec3<Value> tangent;
    Value factor;
  };

  /// a + b1 m1 - b2 m2
  template <class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Value plus_cross(Value const& a, Value const& b1,
                                                      Value const& m1, Value const& b2,
                                                      Value const& m2) {
    return multiply_subtract(b1, m1, multiply_subtract(b2, m2, a));
  }

  template <class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION Turn<Value> turn_of(Numbers const& code) const {
    if constexpr (OnHost && has_table_of_sixteen<Numbers>) {
      Numbers const sign = sign_if<4>(code);
      return {{value<Value>(look_up(tables_.x, code) ^ sign),
               value<Value>(look_up(tables_.y, code) ^ sign),
               value<Value>(look_up(tables_.z, code) ^ sign)},
              value<Value>(look_up(tables_.factor, code))};
    }
    return computed<Value>(code);
  }

  /// Bits 2 and 3 are 0 for a turn about a diagonal; otherwise they choose an axis, with bit 0 for
  /// a turn about it. The others are signs.
  template <class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION Turn<Value> computed(Numbers const& code) const {
    Numbers const is_diagonal = mask<Numbers>((code & 12) == 0);
    Numbers const sign = sign_if<4>(code);
    return {{value<Value>(sign ^ tangent<5>(code, is_diagonal)),
             value<Value>(sign ^ sign_if<0>(code) ^ tangent<9>(code, is_diagonal)),
             value<Value>(sign ^ sign_if<1>(code) ^ tangent<13>(code, is_diagonal))},
            value<Value>((is_diagonal & Kokkos::bit_cast<Bits>(diagonal_factor_)) |
                         (~is_diagonal & Kokkos::bit_cast<Bits>(axial_factor_)))};
  }
  template <int Axis, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION Numbers tangent(Numbers const& code,
                                              Numbers const& is_diagonal) const {
    Numbers const is_axial = mask<Numbers>((code & 13) == Axis);
    return (is_diagonal & Kokkos::bit_cast<Bits>(diagonal_)) |
           (is_axial & Kokkos::bit_cast<Bits>(axial_));
  }
  /// The bit of a minus where this bit of a code is 1.
  template <int Bit, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION static Numbers sign_if(Numbers const& code) {
    constexpr int top = 8 * sizeof(Bits) - 1;
    return (code << (top - Bit)) & (Bits{1} << top);
  }
  /// All bits where a condition holds.
  template <class Numbers, class Condition>
  KOKKOS_FORCEINLINE_FUNCTION static Numbers mask(Condition const& condition) {
    if constexpr (std::is_same_v<Condition, bool>)
      return condition ? ~Numbers{0} : Numbers{0};
    else
      return reinterpret_cast<Numbers>(condition);
  }
  template <class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION static Value value(Numbers const& bits) {
    Real numbers[std::size_t{lanes_of<Value>}];
    std::memcpy(numbers, &bits, sizeof numbers);
    return load<Value>(numbers);
  }

  struct Tables {
    alignas(64) Real x[16] = {}, y[16] = {}, z[16] = {}, factor[16] = {};  // of codes below 16
  };
  struct Nothing {};

  Real axial_ = 0, diagonal_ = 0, axial_factor_ = 0, diagonal_factor_ = 0;
  std::conditional_t<OnHost, Tables, Nothing> tables_;
};

}  // namespace cayspin::inline v0_1::detail
