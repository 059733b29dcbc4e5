// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/detail/memory.hpp>
#include <cayspin/detail/table_of_sixteen.hpp>
#include <cayspin/vec3.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace cayspin::inline v0_2::detail {

/// Functor that turns m into exp(v) m = m + factor * tangent x (m + tangent x m), with tangent =
/// tan(|v| / 2) * v / |v| and factor = 2 * cos^2(|v| / 2).
template <class Value>
struct TurnByTangent {
  Vec3<Value> tangent;
  Value factor;

  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> operator()(Vec3<Value> const& m) const {
    auto const& b = tangent;
    Vec3<Value> const half{plus_cross(m.x, b.y, m.z, b.z, m.y), plus_cross(m.y, b.z, m.x, b.x, m.z),
                           plus_cross(m.z, b.x, m.y, b.y, m.x)};
    return multiply_add(factor, cross(b, half), m);
  }

 private:
  /// Returns a + b1 * m1 - b2 * m2.
  KOKKOS_FORCEINLINE_FUNCTION static Value plus_cross(Value const& a, Value const& b1,
                                                      Value const& m1, Value const& b2,
                                                      Value const& m2) {
    return multiply_subtract(b1, m1, multiply_subtract(b2, m2, a));
  }
};

/// Selects one of the 32 turns of RandomTurn by five bits. `Numbers` has one word, of type Bits,
/// for each lane.
template <class Real>
struct ChoiceOfTurn {
  using Bits = std::conditional_t<sizeof(Real) == 8, std::uint64_t, std::uint32_t>;

  /// If bits 2 and 3 are 0, the turn is about a diagonal, with signs from bits 0, 1 and 4.
  /// Otherwise bits 2 and 3 choose an axis, and there is a turn about it only if bit 0 is set. Its
  /// sign comes from bit 4 or, about z, from bits 1 and 4. The tangents and factors are Reals,
  /// passed as words with the same bits.
  template <class Value, class Numbers, class Words>
  KOKKOS_FORCEINLINE_FUNCTION static TurnByTangent<Value> of(Numbers const& code,
                                                             Words const& axial,
                                                             Words const& diagonal,
                                                             Words const& axial_factor,
                                                             Words const& diagonal_factor) {
    Numbers const is_diagonal = mask<Numbers>((code & 12) == 0);
    Numbers const sign = sign_if<4>(code);
    return {{value<Value>(Numbers(sign ^ tangent<5>(code, is_diagonal, axial, diagonal))),
             value<Value>(
                 Numbers(sign ^ sign_if<0>(code) ^ tangent<9>(code, is_diagonal, axial, diagonal))),
             value<Value>(Numbers(sign ^ sign_if<1>(code) ^
                                  tangent<13>(code, is_diagonal, axial, diagonal)))},
            value<Value>(Numbers((is_diagonal & diagonal_factor) | (~is_diagonal & axial_factor)))};
  }

  /// Returns a word whose sign bit is set if bit `Bit` of the code is 1; its other bits are 0.
  template <int Bit, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION static Numbers sign_if(Numbers const& code) {
    constexpr int top = 8 * sizeof(Bits) - 1;
    return (code << (top - Bit)) & (Bits{1} << top);
  }
  template <class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION static Value value(Numbers const& bits) {
    Real numbers[std::size_t{lanes_of<Value>}];
    std::memcpy(numbers, &bits, sizeof numbers);
    return load<Value>(numbers);
  }
  template <class Numbers, class Value>
  KOKKOS_FORCEINLINE_FUNCTION static Numbers bits(Value const& value) {
    Real numbers[std::size_t{lanes_of<Value>}];
    store(value, numbers);
    Numbers bits;
    std::memcpy(&bits, numbers, sizeof numbers);
    return bits;
  }

 private:
  template <int Axis, class Numbers, class Words>
  KOKKOS_FORCEINLINE_FUNCTION static Numbers tangent(Numbers const& code,
                                                     Numbers const& is_diagonal, Words const& axial,
                                                     Words const& diagonal) {
    Numbers const is_axial = mask<Numbers>((code & 13) == Axis);
    return (is_diagonal & diagonal) | (is_axial & axial);
  }
  /// Returns a word of ones in lanes in which the condition holds, and of zeros elsewhere.
  template <class Numbers, class Condition>
  KOKKOS_FORCEINLINE_FUNCTION static Numbers mask(Condition const& condition) {
    if constexpr (std::is_same_v<Condition, bool>)
      return condition ? ~Numbers{0} : Numbers{0};
    else
      return reinterpret_cast<Numbers>(condition);
  }
};

/// Random rotation: turns m into exp(v) m, where five random bits choose v. In 12 of the 32 cases v
/// is 0, in 12 it is +-2 * s along an axis, and in 8 it is sqrt(2) * s * (+-1, +-1, +-1). The
/// moments of v up to the fifth are those of three independent normal numbers of standard deviation
/// s; a step of weak order 2 depends on no other moments (Kloeden and Platen 1992, Sec. 14.2).
template <class Real, bool OnHost>
class RandomTurn {
  using Choice = ChoiceOfTurn<Real>;

 public:
  using Bits = typename Choice::Bits;

  RandomTurn() = default;
  /// `variance`: s^2, the variance of each component of v.
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

  /// Returns the four numbers that RandomTurnOfNumbers holds for a lane.
  std::array<Real, 4> numbers() const {
    return {axial_, diagonal_, axial_factor_, diagonal_factor_};
  }

  /// Returns m after the turn that five bits choose, from bit `First` of `numbers` on.
  template <int First, class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> turned(Numbers const& numbers,
                                                 Vec3<Value> const& m) const {
    return turn_of<Value>(Numbers(numbers >> First))(m);
  }

 private:
  template <class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION TurnByTangent<Value> turn_of(Numbers const& code) const {
    if constexpr (OnHost && has_table_of_sixteen<Numbers>) {
      Numbers const sign = Choice::template sign_if<4>(code);
      return {{Choice::template value<Value>(Numbers(look_up(tables_.x, code) ^ sign)),
               Choice::template value<Value>(Numbers(look_up(tables_.y, code) ^ sign)),
               Choice::template value<Value>(Numbers(look_up(tables_.z, code) ^ sign))},
              Choice::template value<Value>(look_up(tables_.factor, code))};
    }
    return computed<Value>(code);
  }
  template <class Value, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION TurnByTangent<Value> computed(Numbers const& code) const {
    return Choice::template of<Value>(
        code, Kokkos::bit_cast<Bits>(axial_), Kokkos::bit_cast<Bits>(diagonal_),
        Kokkos::bit_cast<Bits>(axial_factor_), Kokkos::bit_cast<Bits>(diagonal_factor_));
  }

  struct Tables {
    alignas(64) Real x[16] = {}, y[16] = {}, z[16] = {}, factor[16] = {};  // for bit 4 = 0
  };
  struct Nothing {};

  Real axial_ = 0, diagonal_ = 0, axial_factor_ = 0, diagonal_factor_ = 0;
  std::conditional_t<OnHost, Tables, Nothing> tables_;
};

/// RandomTurn with a different variance in each lane. The members hold the four
/// RandomTurn::numbers() of each lane. The result in a lane is bitwise identical to that of the
/// RandomTurn with these numbers.
template <class Real, class Value>
struct RandomTurnOfNumbers {
  Value axial, diagonal, axial_factor, diagonal_factor;

  template <int First, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> turned(Numbers const& numbers,
                                                 Vec3<Value> const& m) const {
    using Choice = ChoiceOfTurn<Real>;
    return Choice::template of<Value>(
        Numbers(numbers >> First), Choice::template bits<Numbers>(axial),
        Choice::template bits<Numbers>(diagonal), Choice::template bits<Numbers>(axial_factor),
        Choice::template bits<Numbers>(diagonal_factor))(m);
  }
};

/// RandomTurn for sites with different variances, each at most 1. Tangents are computed as
/// quotients of polynomials. They are too small: at variance 1 by up to 3e-6 of their value, at
/// variances below 0.01 by less than round-off. This shortens v by O(s^11); the moments of v still
/// suffice for weak order 2.
template <class Real, class Value>
class RandomTurnOfSites {
  using Choice = ChoiceOfTurn<Real>;

 public:
  KOKKOS_FORCEINLINE_FUNCTION explicit RandomTurnOfSites(Value const& variance)
      : axial_(tangent_of_root(variance)),
        diagonal_(tangent_of_root(Value(Value(Real(1.5)) * variance))) {}

  template <int First, class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION Vec3<Value> turned(Numbers const& numbers,
                                                 Vec3<Value> const& m) const {
    Value const along_axis(Real(0.57735026918962576));  // components of a unit diagonal
    return Choice::template of<Value>(Numbers(numbers >> First), bits<Numbers>(axial_),
                                      bits<Numbers>(Value(along_axis * diagonal_)),
                                      bits<Numbers>(factor(axial_)),
                                      bits<Numbers>(factor(diagonal_)))(m);
  }

 private:
  template <class Numbers>
  KOKKOS_FORCEINLINE_FUNCTION static Numbers bits(Value const& value) {
    return Choice::template bits<Numbers>(value);
  }
  /// Returns tan(sqrt(x)), by the first five levels of the continued fraction of the tangent.
  KOKKOS_FORCEINLINE_FUNCTION static Value tangent_of_root(Value const& x) {
    Value const numerator = (x - Value(Real(105))) * x + Value(Real(945));
    Value const denominator = (Value(Real(15)) * x - Value(Real(420))) * x + Value(Real(945));
    return Kokkos::sqrt(x) * numerator / denominator;
  }
  KOKKOS_FORCEINLINE_FUNCTION static Value factor(Value const& tangent) {
    return Value(Real(2)) / (Value(Real(1)) + tangent * tangent);
  }

  Value axial_, diagonal_;
};

}  // namespace cayspin::inline v0_2::detail
