// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Newell's tensor against what any demagnetising tensor obeys, and mumax3's quadrature of it.
#include "../../examples/standard_problem_4/newell.hpp"
#include "../../examples/standard_problem_4/quadrature.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <limits>
#include <numbers>

namespace {

using Lengths = std::array<double, 3>;

constexpr Lengths cube{1, 1, 1}, thin{500. / 128, 125. / 32, 3};

double trace(Tensor const& n) { return n.xx + n.yy + n.zz; }

double largest_difference(Tensor const& a, Tensor const& b) {
  double largest = 0;
  for (double const d :
       {a.xx - b.xx, a.yy - b.yy, a.zz - b.zz, a.xy - b.xy, a.xz - b.xz, a.yz - b.yz})
    largest = std::fmax(largest, std::abs(d));
  return largest;
}

/// Of a moment at a point: (1 - 3 r r / r^2) V / (4 pi r^3).
Tensor of_dipole(Lengths const& r, Lengths const& size) {
  double const square = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  double const strength =
      size[0] * size[1] * size[2] / (4 * std::numbers::pi * square * std::sqrt(square));
  auto const entry = [&](std::size_t i, std::size_t j) {
    return strength * ((i == j ? 1 : 0) - 3 * r[i] * r[j] / square);
  };
  return {entry(0, 0), entry(1, 1), entry(2, 2), entry(0, 1), entry(0, 2), entry(1, 2)};
}

TEST(NewellTensor, OfACubeIsAThird) {
  Tensor const n = newell::tensor({0, 0, 0}, cube);
  EXPECT_NEAR(n.xx, 1. / 3, 1e-15);
  EXPECT_NEAR(n.yy, 1. / 3, 1e-15);
  EXPECT_NEAR(n.zz, 1. / 3, 1e-15);
  EXPECT_NEAR(n.xy, 0, 1e-16);
  EXPECT_NEAR(n.xz, 0, 1e-16);
  EXPECT_NEAR(n.yz, 0, 1e-16);
}

// 1 in the cell itself, 0 outside: the divergence of the field.
TEST(NewellTensor, HasTheTraceOfTheDivergence) {
  double const round_off = static_cast<double>(std::numeric_limits<long double>::epsilon()) * 1e9;
  for (int z = -2; z <= 2; ++z)
    for (int y = -31; y < 32; y += 2)
      for (int x = -127; x < 128; x += 3) {
        Tensor const n = newell::tensor({x * thin[0], y * thin[1], z * thin[2]}, thin);
        EXPECT_NEAR(trace(n), 0, round_off + 1e-15) << x << " " << y << " " << z;
      }
  EXPECT_NEAR(trace(newell::tensor({0, 0, 0}, thin)), 1, 1e-14);
  EXPECT_NEAR(trace(newell::tensor({0, 0, 0}, {100, 1, 0.01})), 1, 1e-12);
}

// The field of a cell minus that of a point falls off faster, by two orders; by four for a cube,
// which has no quadrupole.
TEST(NewellTensor, IsThatOfADipoleFarAway) {
  struct Case {
    Lengths size;
    double order, far;
  };
  for (Case const& one : {Case{cube, 4, 1e-5}, Case{thin, 2, 2e-3}}) {
    auto const error = [&](double distance) {
      Lengths const r{0.6 * distance, -0.64 * distance, 0.48 * distance};
      return largest_difference(newell::tensor(r, one.size), of_dipole(r, one.size)) /
             std::abs(of_dipole(r, one.size).xy);
    };
    double const near = error(16 * one.size[0]), far = error(32 * one.size[0]);
    EXPECT_NEAR(std::log2(near / far), one.order, 0.1);
    EXPECT_LT(far, one.far);
  }
}

TEST(NewellTensor, TurnsWithTheAxes) {
  Tensor const n = newell::tensor({3, -4, 6}, {1, 2, 1.5});
  Tensor const turned = newell::tensor({-4, 6, 3}, {2, 1.5, 1});  // x, y, z <- y, z, x
  EXPECT_NEAR(turned.xx, n.yy, 1e-14);
  EXPECT_NEAR(turned.yy, n.zz, 1e-14);
  EXPECT_NEAR(turned.zz, n.xx, 1e-14);
  EXPECT_NEAR(turned.xy, n.yz, 1e-14);
  EXPECT_NEAR(turned.xz, n.xy, 1e-14);
  EXPECT_NEAR(turned.yz, n.xz, 1e-14);
  EXPECT_GT(std::abs(n.xy), 1e-4);
}

// A film's middle feels -M along its normal, less what is beyond its edges.
TEST(NewellTensor, SumsToThatOfAFilm) {
  Tensor sum{};
  constexpr int half = 60;
  for (int y = -half; y <= half; ++y)
    for (int x = -half; x <= half; ++x) {
      Tensor const n = newell::tensor({1. * x, 1. * y, 0}, cube);
      sum.xx += n.xx;
      sum.zz += n.zz;
      sum.xy += n.xy;
    }
  double const beyond = std::sqrt(2.) * 2 / (std::numbers::pi * (2 * half + 1));  // of a square
  EXPECT_NEAR(sum.zz, 1 - beyond, 1e-5);
  EXPECT_NEAR(sum.xx, 0.5 * beyond, 1e-5);
  EXPECT_NEAR(sum.xy, 0, 1e-12);
}

TEST(Quadrature, ErrsLittle) {
  double largest = 0;
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 4; ++x) {
      Lengths const r{x * thin[0], y * thin[1], 0};
      largest = std::fmax(largest,
                          largest_difference(quadrature::tensor(r, thin), newell::tensor(r, thin)));
    }
  EXPECT_LT(largest, 2.5e-4);
  EXPECT_GT(largest, 2e-4);
}

}  // namespace
