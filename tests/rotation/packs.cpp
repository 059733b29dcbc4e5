// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Each lane of a pack gets the result that a single number would get.
#include "reference.hpp"

namespace cayspin::test {
namespace {

template <class Real>
class Packs : public ::testing::Test {
 protected:
  using Pack = detail::Pack<Real>;
  static constexpr int lanes = detail::lanes_of<Pack>;

  static Vec3<Pack> gather(std::vector<Vec3<Real>> const& values) {
    Real x[lanes], y[lanes], z[lanes];
    for (int i = 0; i < lanes; ++i) x[i] = values[i].x, y[i] = values[i].y, z[i] = values[i].z;
    return {detail::load<Pack>(x), detail::load<Pack>(y), detail::load<Pack>(z)};
  }

  // Packs and single numbers give bitwise identical results, unless the compiler may contract
  // operations. Then components, which are differences, may differ by the round-off of the whole
  // vector.
  static void expect_equal(Vec3<Real> const& pack, Vec3<Real> const& number, char const* what) {
    auto const expect = [&](Real a, Real b) {
#if defined(CAYSPIN_TEST_CONTRACTED)
      EXPECT_NEAR(a, b, 8 * epsilon<Real> * std::max(Real(1), std::sqrt(dot(number, number))))
          << what;
#else
      EXPECT_EQ(a, b) << what;
#endif
    };
    expect(pack.x, number.x), expect(pack.y, number.y), expect(pack.z, number.z);
  }

  static constexpr int cayley_limit = sizeof(Real) == sizeof(double) ? 150 : 18,
                       limit = sizeof(Real) == sizeof(double) ? 306 : 37;  // powers of ten

  template <class Map>
  static void compare(char const* what, int largest_power, Map const& map) {
    for (int round = 0; round < 40; ++round) {
      std::vector<Vec3<Real>> f, x;
      for (int i = 0; i < lanes; ++i) {
        // A pack contains vectors of very different sizes, in every second round up to the limits.
        int const number = i * 7 + round;
        int const power = round % 2 == 0 ? number % 24 - 18 : largest_power * (number % 7 - 3) / 3;
        long double const size = std::pow(10.0L, power);
        f.push_back(narrow<Real>(size * direction(round * lanes + i)));
        x.push_back(narrow<Real>(direction(5000 + round * lanes + i)));
      }
      auto const together = map(gather(f), gather(x));
      Real px[lanes], py[lanes], pz[lanes];
      detail::store(together.x, px), detail::store(together.y, py), detail::store(together.z, pz);
      for (int i = 0; i < lanes; ++i) {
        expect_equal({px[i], py[i], pz[i]}, map(f[i], x[i]), what);
      }
    }
  }
};
TYPED_TEST_SUITE(Packs, Precisions, PrecisionName);

TYPED_TEST(Packs, LanesEqualNumbers) {
  this->compare("Cayley::rotate", this->cayley_limit,
                [](auto const& f, auto const& x) { return Cayley::rotate(f, x); });
  this->compare("Cayley::differential", this->cayley_limit,
                [](auto const& f, auto const& x) { return Cayley::differential(f, x); });
  this->compare("Cayley::inverse_differential", this->cayley_limit,
                [](auto const& f, auto const& x) { return Cayley::inverse_differential(f, x); });
  this->compare("OverflowSafeCayley::rotate", this->limit,
                [](auto const& f, auto const& x) { return OverflowSafeCayley::rotate(f, x); });
  this->compare("OverflowSafeCayley::differential", this->limit, [](auto const& f, auto const& x) {
    return OverflowSafeCayley::differential(f, x);
  });
  this->compare("Exponential::rotate", this->limit,
                [](auto const& f, auto const& x) { return Exponential::rotate(f, x); });
  this->compare("Exponential::inverse_differential", 5, [](auto const& f, auto const& x) {
    return Exponential::inverse_differential(f, x);
  });
}

}  // namespace
}  // namespace cayspin::test
