// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Tests the exponential's own sine and cosine in every range and branch of rotation/half_angle.hpp.
#include "reference.hpp"

namespace cayspin::test {
namespace {

template <class Real>
class ExponentialMap : public ::testing::Test {
 protected:
  static constexpr bool is_double = std::is_same_v<Real, double>;
  static constexpr double eps = epsilon<Real>;

  static void expect_rotated(Vec3<Real> const& f, unsigned seed) {
    auto const x = narrow<Real>(direction(seed));
    long double const size = norm(widen(f));
    EXPECT_LE(largest(widen(Exponential::rotate(f, x)) - exponential(widen(f), widen(x))),
              eps * (3 + size))
        << "|f| = " << size;
  }

  /// Returns numbers around a threshold: the threshold itself, its neighbours, and numbers a little
  /// further away.
  static std::vector<Real> around(Real value) {
    Real const up = std::nextafter(value, std::numeric_limits<Real>::max());
    Real const down = std::nextafter(value, Real(0));
    return {value, up, down, value * Real(1 + 8 * eps), value * Real(1 - 8 * eps)};
  }

  /// The y and z components of exp(f) e_x come only from sin|f| / |f| * (f x e_x), so they are
  /// compared relative to their own size.
  static void expect_small_angle(Real size) {
    for (auto const& [f, along] :
         {std::pair{Vec3<Real>{0, 0, size}, size}, std::pair{Vec3<Real>{0, -size, 0}, size},
          std::pair{Vec3<Real>{0, Real(0.6) * size, Real(0.8) * size}, Real(0.8) * size}}) {
      auto const turned = Exponential::rotate(f, Vec3<Real>{1, 0, 0});
      Long const expected = exponential(widen(f), {1, 0, 0});
      Long const found = widen(turned);
      long double const bound = 4 * eps * along + 2 * std::numeric_limits<Real>::denorm_min();
      EXPECT_LE(std::abs(found[1] - expected[1]), bound) << size;
      EXPECT_LE(std::abs(found[2] - expected[2]), bound) << size;
    }
  }
};
TYPED_TEST_SUITE(ExponentialMap, Precisions, PrecisionName);

TYPED_TEST(ExponentialMap, SweepOverSizes) {
  using Real = TypeParam;
  unsigned seed = 0;
  for (long double size = this->is_double ? 1e-300L : 1e-38L; size < 1e6L; size *= 1.3L) {
    this->expect_rotated(narrow<Real>(size * direction(seed)), seed + 1);
    seed += 2;
  }
}

TYPED_TEST(ExponentialMap, SmallAnglesToFullRelativePrecision) {
  using Real = TypeParam;
  for (long double size = this->is_double ? 1e-300L : 1e-36L; size < 0.5L; size *= 1.7L)
    this->expect_small_angle(static_cast<Real>(size));
  // Below `tiny` the length is not resolved, and the sine is replaced by its argument.
  Real const tiny = this->is_double ? Real(0x1p-500) : Real(0x1p-60);
  for (Real const size : this->around(tiny)) this->expect_small_angle(size);
}

// Along a coordinate axis |f| is known exactly, and so is the angle: its reduction by multiples of
// pi must not lose more digits for larger angles.
TYPED_TEST(ExponentialMap, KnownAnglesToFullPrecision) {
  using Real = TypeParam;
  for (long double size = 1; size < 1e6L; size *= 1.0003L) {
    Vec3<Real> const f{0, static_cast<Real>(size), 0};
    Long const expected = exponential(widen(f), {0.6L, 0, 0.8L});
    auto const found = widen(Exponential::rotate(f, narrow<Real>({0.6L, 0, 0.8L})));
    EXPECT_LE(largest(found - expected), 8 * this->eps) << size;
  }
}

// Half of |f| is reduced by multiples of pi to -pi/2 .. pi/2, so odd multiples of pi switch
// branches.
TYPED_TEST(ExponentialMap, ThroughMultiplesOfPi) {
  using Real = TypeParam;
  long double const pi = 3.14159265358979323846264338L;
  unsigned seed = 0;
  for (int k = 1; k < 40; ++k)
    for (Real const size : this->around(static_cast<Real>(k * pi))) {
      this->expect_rotated({size, 0, 0}, seed + 1);
      this->expect_rotated({0, 0, -size}, seed + 2);
      this->expect_rotated(narrow<Real>(static_cast<long double>(size) * direction(seed)),
                           seed + 3);
      seed += 3;
    }
  // A dense sweep covers every range of the polynomials.
  for (int i = 0; i < 4000; ++i)
    this->expect_rotated(narrow<Real>((i * 0.01L) * direction(i)), i + 1);
}

// If the square of |f| overflows, f is scaled first. The angle then has no meaning, but the
// rotation's axis and the spin's length are kept.
TYPED_TEST(ExponentialMap, LargeCoordinatesKeepTheAxisAndTheSphere) {
  using Real = TypeParam;
  auto sizes = this->around(this->is_double ? Real(0x1p500) : Real(0x1p60));
  for (int exponent = 20; exponent < (this->is_double ? 1020 : 124); exponent += 3)
    sizes.push_back(std::ldexp(Real(1.1), exponent));
  unsigned seed = 0;
  for (Real const size : sizes) {
    seed += 2;
    auto const x = narrow<Real>(direction(seed + 1));
    for (auto const& f :
         {Vec3<Real>{0, size, 0}, narrow<Real>(static_cast<long double>(size) * direction(seed))}) {
      auto const turned = widen(Exponential::rotate(f, x));
      Long const axis = (1 / norm(widen(f))) * widen(f);
      EXPECT_NEAR(norm(turned), norm(widen(x)), 6 * this->eps) << size;
      EXPECT_NEAR(inner(axis, turned), inner(axis, widen(x)), 6 * this->eps) << size;
    }
  }
}

// |f| goes from 0 through 1/2, where the closed form replaces the series, to 6.
TYPED_TEST(ExponentialMap, InverseTangentThroughItsSwitch) {
  using Real = TypeParam;
  unsigned seed = 0;
  auto const check = [&](Vec3<Real> const& f) {
    auto const y = narrow<Real>(direction(++seed));
    Long const expected = exponential_inverse_tangent(widen(f), widen(y));
    // The nearer |f| is to 2 * pi, the more the coefficient depends on errors of its angle.
    long double const n = norm(widen(f)), to_pole = 6.2831853L - n;
    EXPECT_LE(largest(widen(Exponential::inverse_differential(f, y)) - expected),
              this->eps * (4 + 8 * n * n / (to_pole * to_pole)))
        << n;
  };
  for (int i = 0; i < 600; ++i) check(narrow<Real>((i * 0.01L) * direction(1000 + i)));
  for (Real const size : this->around(Real(0.5))) {
    check({size, 0, 0});
    check({0, -size, 0});
    for (int i = 0; i < 50; ++i)
      check(narrow<Real>(static_cast<long double>(size) * direction(5000 + i)));
  }
  for (int exponent = -40; exponent < 0; ++exponent)
    check(narrow<Real>(std::ldexp(1.1L, exponent) * direction(9000 - exponent)));
}

}  // namespace
}  // namespace cayspin::test
