// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The maps compared with 32-digit values; packs.cpp compares packs with single numbers. In float
// the inputs are first rounded (and clamped to the range), and the reference is computed in long
// double.
#include "../support/oracles.hpp"
#include "reference.hpp"

namespace cayspin::test {
namespace {

template <class Real>
struct MapCase {
  std::string tag;
  Vec3<Real> f, x, y;
  Long cayley, tangent, inverse_differential, exponential;
  bool has_exponential;
};

// For float, which holds 1e-45 .. 3e38, scales a vector so that its largest component is in 1e-40
// .. 1e37.
template <class Real>
Long in_range(Long const& f) {
  long double const size = largest(f);
  if (sizeof(Real) == sizeof(double) || size == 0) return f;
  if (size > 1e37L) return (1e37L / size) * f;
  if (size < 1e-40L) return (1e-40L / size) * f;
  return f;
}

Long read_long(nlohmann::json const& array) {
  return {decimal(array.at(0)), decimal(array.at(1)), decimal(array.at(2))};
}

template <class Real>
std::vector<MapCase<Real>> map_cases() {
  std::vector<MapCase<Real>> cases;
  for (auto const& entry : oracles("maps")) {
    MapCase<Real> one;
    one.tag = entry.at("tag");
    one.f = narrow<Real>(in_range<Real>(read_long(entry.at("f"))));
    one.x = narrow<Real>(read_long(entry.at("x")));
    one.y = narrow<Real>(read_long(entry.at("y")));
    one.has_exponential = entry.contains("exp_f_x");
    if constexpr (std::is_same_v<Real, double>) {
      one.cayley = read_long(entry.at("cay_f_x"));
      one.tangent = read_long(entry.at("dcay_f_y"));
      one.inverse_differential = read_long(entry.at("dcayinv_f_y"));
      if (one.has_exponential) one.exponential = read_long(entry.at("exp_f_x"));
    } else {
      Long const f = widen(one.f), x = widen(one.x), y = widen(one.y);
      one.cayley = test::cayley(f, x);
      one.tangent = cayley_tangent(f, y);
      one.inverse_differential = cayley_inverse_tangent(f, y);
      one.exponential = test::exponential(f, x);
    }
    cases.push_back(one);
  }
  return cases;
}

template <class Real>
class Maps : public ::testing::Test {
 protected:
  static constexpr double tolerance = 1e-13 / epsilon<double> * epsilon<Real>;
  static constexpr bool is_double = std::is_same_v<Real, double>;
  static constexpr double cayley_limit = is_double ? 1e150 : 1e18;

  static void expect_near(Vec3<Real> const& found, Long const& expected, long double error,
                          std::string const& what) {
    EXPECT_LE(largest(widen(found) - expected), error) << what;
  }

  template <class Rotation>
  static void check_cayley(MapCase<Real> const& one) {
    expect_near(Rotation::rotate(one.f, one.x), one.cayley, tolerance, one.tag + ": cay");
    expect_near(Rotation::differential(one.f, one.y), one.tangent, tolerance * largest(one.tangent),
                one.tag + ": dcay");
    if (largest(one.inverse_differential) < 0.25L * std::numeric_limits<Real>::max())
      expect_near(Rotation::inverse_differential(one.f, one.y), one.inverse_differential,
                  tolerance * largest(one.inverse_differential), one.tag + ": inverse dcay");
  }
};
TYPED_TEST_SUITE(Maps, Precisions, PrecisionName);

TYPED_TEST(Maps, CayleyUpToItsLimit) {
  int checked = 0;
  for (auto const& one : map_cases<TypeParam>()) {
    if (largest(widen(one.f)) > TestFixture::cayley_limit) continue;
    this->template check_cayley<Cayley>(one);
    ++checked;
  }
  EXPECT_EQ(checked, TestFixture::is_double ? 14 : 13);
}

TYPED_TEST(Maps, OverflowSafeCayleyEverywhere) {
  for (auto const& one : map_cases<TypeParam>())
    this->template check_cayley<OverflowSafeCayley>(one);
}

TYPED_TEST(Maps, Exponential) {
  for (auto const& one : map_cases<TypeParam>()) {
    long double const size = norm(widen(one.f));
    auto const found = Exponential::rotate(one.f, one.x);
    EXPECT_NEAR(norm(widen(found)), norm(widen(one.x)), 8 * epsilon<TypeParam>) << one.tag;
    if (one.has_exponential && size < 0.1 / epsilon<TypeParam>)
      this->expect_near(found, one.exponential,
                        std::max<long double>(this->tolerance, 8 * epsilon<TypeParam> * size),
                        one.tag + ": exp");
  }
}

// The tests above skip values of the inverse differential that overflow. The file of reference
// values flags those that overflow double.
TEST(Maps, TheInverseTangentIsCheckedWhereItFits) {
  for (auto const& entry : oracles("maps")) {
    auto const value = read_long(entry.at("dcayinv_f_y"));
    EXPECT_EQ(largest(value) > std::numeric_limits<double>::max(),
              entry.at("dcayinv_overflows_double").get<bool>())
        << entry.at("tag");
  }
}

// The formulas in long double, which replace the file in float, agree with the file.
TEST(Maps, TheReferenceAgreesWithTheFile) {
  for (auto const& one : map_cases<double>()) {
    Long const f = widen(one.f), x = widen(one.x), y = widen(one.y);
    EXPECT_LE(largest(cayley(f, x) - one.cayley), 1e-17L) << one.tag;
    EXPECT_LE(largest(cayley_tangent(f, y) - one.tangent), 1e-17L * largest(one.tangent))
        << one.tag;
    EXPECT_LE(largest(cayley_inverse_tangent(f, y) - one.inverse_differential),
              1e-17L * largest(one.inverse_differential))
        << one.tag;
    if (one.has_exponential) {
      EXPECT_LE(largest(exponential(f, x) - one.exponential), 1e-18L * (10 + norm(f))) << one.tag;
    }
  }
}

}  // namespace
}  // namespace cayspin::test
