// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Properties of the maps that do not depend on their formulas: inverses, lengths, and differentials
// compared with differences of the maps.
#include "reference.hpp"

namespace cayspin::test {
namespace {

template <class Real>
class Laws : public ::testing::Test {
 protected:
  static constexpr double eps = epsilon<Real>;

  /// Calls check(f, x, y) for |f| from 1e-30 to `largest_size`; x and y are unit vectors.
  template <class Check>
  static void sweep(double largest_size, Check const& check) {
    unsigned seed = 1;
    for (double size = 1e-30; size <= largest_size; size *= 1.7) {
      check(narrow<Real>(static_cast<long double>(size) * direction(seed)),
            narrow<Real>(direction(seed + 1)), narrow<Real>(direction(seed + 2)));
      seed += 3;
    }
  }
  static Vec3<Real> opposite(Vec3<Real> const& f) { return {-f.x, -f.y, -f.z}; }

  template <class Rotation>
  static void inverses_and_lengths(double largest_size) {
    sweep(largest_size, [](auto const& f, auto const& x, auto const&) {
      auto const there = Rotation::rotate(f, x);
      EXPECT_NEAR(norm(widen(there)), norm(widen(x)), 6 * eps) << norm(widen(f));
      // Each rotation adds a vector of length at most 2 to x, with a relative error of 3 eps.
      EXPECT_LE(largest(widen(Rotation::rotate(opposite(f), there)) - widen(x)), 12 * eps)
          << norm(widen(f));
    });
  }

  template <class Rotation>
  static void tangents_are_inverse() {
    sweep(1e6, [](auto const& f, auto const&, auto const& y) {
      long double const bound = 8 * eps * (1 + norm(widen(f)));
      EXPECT_LE(largest(widen(Rotation::differential(f, Rotation::inverse_differential(f, y))) -
                        widen(y)),
                bound)
          << norm(widen(f));
      EXPECT_LE(largest(widen(Rotation::inverse_differential(f, Rotation::differential(f, y))) -
                        widen(y)),
                bound)
          << norm(widen(f));
    });
  }
};
TYPED_TEST_SUITE(Laws, Precisions, PrecisionName);

TYPED_TEST(Laws, OppositeCoordinatesTurnBack) {
  bool const is_double = std::is_same_v<TypeParam, double>;
  this->template inverses_and_lengths<Cayley>(is_double ? 1e150 : 1e18);
  this->template inverses_and_lengths<OverflowSafeCayley>(is_double ? 1e300 : 1e37);
  this->template inverses_and_lengths<Exponential>(is_double ? 1e300 : 1e37);
}

TYPED_TEST(Laws, TheTangentUndoesItsInverse) {
  this->template tangents_are_inverse<Cayley>();
  this->template tangents_are_inverse<OverflowSafeCayley>();
}

/// Returns d/ds map(f + s * g) x at s = 0, by differences of fourth order.
template <class Map>
Long derivative(Map const& map, Long const& f, Long const& g, Long const& x) {
  long double const s = 1e-4L;
  auto const at = [&](long double factor) { return map(f + (factor * s) * g, x); };
  return (1 / (12 * s)) * (8 * (at(1) - at(-1)) - (at(2) - at(-2)));
}

// The differential is right-trivialised: d/ds R(f) v = (dR_f f') x R(f) v for a fixed vector v. The
// left-trivialised one is the right-trivialised one of -f; it must not agree with the differences.
TYPED_TEST(Laws, CayleyTangentIsTheDerivative) {
  using Real = TypeParam;
  this->sweep(30, [&](auto const& f, auto const& x, auto const& g) {
    Long const moved = cayley(widen(f), widen(x));
    Long const rate = derivative(cayley, widen(f), widen(g), widen(x));
    double const bound = 16 * this->eps + 1e-14;
    for (auto const& tangent : {Cayley::differential(f, g), OverflowSafeCayley::differential(f, g)})
      EXPECT_LE(largest(outer(widen(tangent), moved) - rate), bound) << norm(widen(f));
    if (norm(widen(f)) > 0.1L && norm(widen(f)) < 10) {
      auto const left = Cayley::differential(Vec3<Real>{-f.x, -f.y, -f.z}, g);
      EXPECT_GT(largest(outer(widen(left), moved) - rate), 1e-3L) << norm(widen(f));
    }
  });
}

TYPED_TEST(Laws, InverseTangentOfTheExponentialIsTheDerivative) {
  using Real = TypeParam;
  for (int i = 0; i < 60; ++i) {
    auto const f = narrow<Real>((0.1L * i) * direction(i));
    auto const x = narrow<Real>(direction(100 + i)), y = narrow<Real>(direction(200 + i));
    Long const moved = exponential(widen(f), widen(x)), rate = outer(widen(y), moved);
    auto const found = [&](Vec3<Real> const& where) {
      Long const g = widen(Exponential::inverse_differential(where, y));
      return largest(derivative(exponential, widen(f), g, widen(x)) - rate);
    };
    // Near |f| = 2 * pi, the map from f to the rotation amplifies errors.
    EXPECT_LE(found(f), (16 * this->eps + 1e-13) / (1 - 0.1 * i / 6.3)) << i;
    if (i < 2) continue;
    EXPECT_GT(found({-f.x, -f.y, -f.z}), 1e-3L) << i;
  }
}

}  // namespace
}  // namespace cayspin::test
