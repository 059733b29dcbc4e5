// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Displacements keep their relative precision at any length; rotations are computed from them.
#include "reference.hpp"

#include <cayspin/stage/update.hpp>

namespace cayspin::test {
namespace {

template <class Real>
class Displacements : public ::testing::Test {};
TYPED_TEST_SUITE(Displacements, Precisions, PrecisionName);

// The reference is the difference of two spins in long double, accurate to 1e-19.
template <class Real, class Map, class Exact>
void expect_digits(char const* name, bool tangent, Map const& displacement, Exact const& exact) {
  double const shortest = sizeof(Real) == sizeof(double) ? 0.01 : 1e-7;
  for (unsigned seed = 1; seed <= 50; ++seed)
    for (double size = shortest; size < 3; size *= 7) {
      auto const directions = random_directions(2, seed);
      Vec3<double> const unit = at(directions, 0), axis = at(directions, 1);
      Vec3<Real> const m{Real(unit.x), Real(unit.y), Real(unit.z)};
      Vec3<double> const along = tangent ? axis - dot(axis, unit) * unit : axis;
      Vec3<Real> const f{Real(size * along.x), Real(size * along.y), Real(size * along.z)};
      Long const expected = exact(widen(f), widen(m)) - widen(m);
      Long const off = widen(displacement(f, m).vector()) - expected;
      EXPECT_LT(norm(off), 6 * epsilon<Real> * norm(widen(f)))
          << name << ' ' << seed << ' ' << size;
    }
}

TYPED_TEST(Displacements, KeepTheirDigits) {
  using Real = TypeParam;
  using Vector = Vec3<Real>;
  auto const by = [](auto update) {
    return [](Vector const& f, Vector const& m) { return decltype(update)::displacement(f, m); };
  };
  auto const exact_chart = [](Long const& f, Long const& m) {
    long double const s = inner(f, f);
    return m + (2 / (1 + s)) * (f - s * m);
  };
  // If |m| is not exactly 1, the projection divides by sqrt(1 + |m + f|^2 - |m|^2), so that f = 0
  // changes nothing.
  auto const exact_projection = [](Long const& f, Long const& m) {
    Long const end = m + f;
    return (1 / std::sqrt(1 + inner(end, end) - inner(m, m))) * end;
  };
  auto const exact_exponential = [](Long const& f, Long const& m) { return exponential(f, m); };
  auto const exact_cayley = [](Long const& f, Long const& m) { return cayley(f, m); };
  expect_digits<Real>("cayley", false, by(update::Lie<Cayley>{}), exact_cayley);
  expect_digits<Real>("safe", false, by(update::Lie<OverflowSafeCayley>{}), exact_cayley);
  expect_digits<Real>("exponential", false, by(update::Lie<Exponential>{}), exact_exponential);
  expect_digits<Real>("chart", true, by(update::Stereographic{}), exact_chart);
  expect_digits<Real>("projected", false, by(update::Projected{}), exact_projection);
}

}  // namespace
}  // namespace cayspin::test
