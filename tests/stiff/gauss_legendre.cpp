// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// The stages of the Gauss method, on one site.
#include "../support/backends.hpp"

#include <cayspin/stepper/gauss_legendre.hpp>

#include <numbers>

namespace cayspin::test {
namespace {

template <class Real>
class GaussLegendreOn : public ::testing::Test {
 protected:
  using Number = long double;
  static constexpr double epsilon = std::numeric_limits<Real>::epsilon();

  Vec3<Real> direction() {
    std::normal_distribution<double> normal;
    Vec3<double> v{normal(engine_), normal(engine_), normal(engine_)};
    v = (1 / std::sqrt(dot(v, v))) * v;
    return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
  }
  static Vec3<Number> wide(Vec3<Real> const& v) { return {v.x, v.y, v.z}; }
  static Number length(Vec3<Number> const& v) { return std::sqrt(dot(v, v)); }

 private:
  std::mt19937 engine_{7};
};
TYPED_TEST_SUITE(GaussLegendreOn, Precisions, PrecisionName);

TYPED_TEST(GaussLegendreOn, SolvesTheEquationsOfItsStages) {
  using Real = TypeParam;
  long double const root = std::numbers::sqrt3_v<long double>;
  long double const a[2][2] = {{0.25L, 0.25L - root / 6}, {0.25L + root / 6, 0.25L}};
  for (double const size : {1e-6, 1e-2, 1.0, 30.0})
    for (int k = 0; k < 100; ++k) {
      auto const m = this->direction();
      Vec3<Real> const f[2] = {Real(size) * this->direction(), Real(size) * this->direction()};
      Vec3<Real> stage[2];
      auto const end = detail::GaussLegendre<2>::solve(f, m, stage);
      Vec3<long double> const slope[2] = {cross(this->wide(f[0]), this->wide(stage[0])),
                                          cross(this->wide(f[1]), this->wide(stage[1]))};
      long double const bound = 16 * this->epsilon * (1 + size);
      for (int i = 0; i < 2; ++i)
        EXPECT_LE(this->length(this->wide(stage[i]) - this->wide(m) - a[i][0] * slope[0] -
                               a[i][1] * slope[1]),
                  bound);
      EXPECT_LE(this->length(this->wide(end) - this->wide(m) - 0.5L * (slope[0] + slope[1])),
                bound);
    }
}

TYPED_TEST(GaussLegendreOn, KeepsTheLength) {
  using Real = TypeParam;
  for (double size = 1e-6; size < 300; size *= 3)
    for (int k = 0; k < 300; ++k) {
      auto const m = this->direction();
      Vec3<Real> const f[2] = {Real(size) * this->direction(), Real(size) * this->direction()};
      Vec3<Real> stage[2];
      auto const end = detail::GaussLegendre<2>::solve(f, m, stage);
      EXPECT_NEAR(static_cast<double>(this->length(this->wide(end)) - this->length(this->wide(m))),
                  0, 2 * this->epsilon)
          << size;
    }
}

TYPED_TEST(GaussLegendreOn, ConstantFieldsTurnByPadesAngle) {
  // The two-stage Gauss method multiplies m_x + i * m_y by (1 + z/2 + z^2/12) / (1 - z/2 + z^2/12),
  // where z = i * |f|.
  using Real = TypeParam;
  for (double const size : {0.01, 0.5, 2.0, 3.0}) {
    Vec3<Real> const f[2] = {{0, 0, Real(size)}, {0, 0, Real(size)}};
    Vec3<Real> stage[2];
    auto const end = detail::GaussLegendre<2>::solve(f, Vec3<Real>{1, 0, 0}, stage);
    double const length = f[0].z, angle = 2 * std::atan2(length / 2, 1 - length * length / 12);
    EXPECT_NEAR(end.x, std::cos(angle), 8 * this->epsilon) << size;
    EXPECT_NEAR(end.y, std::sin(angle), 8 * this->epsilon) << size;
    EXPECT_EQ(end.z, 0) << size;
  }
}

}  // namespace
}  // namespace cayspin::test
