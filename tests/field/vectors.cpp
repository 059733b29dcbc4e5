// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Arithmetic of Vec3 with numbers of any type, for plain numbers and for packs.
#include "../support/backends.hpp"

#include <cayspin/vec3.hpp>

#include <type_traits>

namespace cayspin::test {
namespace {

template <class Real>
class Vectors : public ::testing::Test {};
TYPED_TEST_SUITE(Vectors, Precisions, PrecisionName);

template <class Value>
void expect_equal(Vec3<Value> const& found, Vec3<double> const& expected) {
  using Real = detail::scalar_t<Value>;
  auto const same = [](Value const& a, double b) {
    return detail::holds_everywhere(a == Value(static_cast<Real>(b)));
  };
  EXPECT_TRUE(same(found.x, expected.x) && same(found.y, expected.y) && same(found.z, expected.z));
}

template <class Value>
void expect_arithmetic() {
  using Real = detail::scalar_t<Value>;
  auto const v = as_value<Value>(Vec3<double>{1, -2, 0.5});
  expect_equal(-v, {-1, 2, -0.5});
  for (auto const& twice :
       {2.0 * v, v * 2.0, 2.0f * v, v * 2.0f, 2 * v, v * 2, Value(Real(2)) * v, v * Value(Real(2))})
    expect_equal(twice, {2, -4, 1});
  // A number is converted to the precision of the vector, not the vector to that of the number.
  double const third = static_cast<Real>(1.0 / 3);
  expect_equal((1.0 / 3) * as_value<Value>(Vec3<double>{1, 2, 4}), {third, 2 * third, 4 * third});
  static_assert(std::is_same_v<decltype(0.1 * v), Vec3<Value>>);
  static_assert(std::is_same_v<decltype(v * 0.1), Vec3<Value>>);
  auto sum = v;
  sum += v;
  expect_equal(sum, {2, -4, 1});
  sum -= v * 3;
  expect_equal(sum, {-1, 2, -0.5});
  expect_equal(zero<Value>(), {0, 0, 0});
  auto const positive = Value(Real(0)) < v.x;
  expect_equal(select<Value>(positive, v, -v), {1, -2, 0.5});
  expect_equal(select<Value>(Value(Real(0)) < v.y, v, zero<Value>()), {0, 0, 0});
}

TYPED_TEST(Vectors, OfNumbers) { expect_arithmetic<TypeParam>(); }
TYPED_TEST(Vectors, OfPacks) { expect_arithmetic<detail::Pack<TypeParam>>(); }

}  // namespace
}  // namespace cayspin::test
