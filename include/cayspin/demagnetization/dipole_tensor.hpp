// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>

namespace cayspin::inline v0_2::detail {

using Point = std::array<double, 3>;

/// A symmetric matrix T: the field of a dipole m is H = T m / (4 * pi).
struct DipoleTensor {
  double xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  DipoleTensor& operator+=(DipoleTensor const& other) { return add(1, other); }
  DipoleTensor& add(double weight, DipoleTensor const& other) {
    xx += weight * other.xx, yy += weight * other.yy, zz += weight * other.zz;
    xy += weight * other.xy, xz += weight * other.xz, yz += weight * other.yz;
    return *this;
  }
  DipoleTensor& add_unit(double weight) {
    xx += weight, yy += weight, zz += weight;
    return *this;
  }
  /// Adds weight * (a b^T + b a^T) / 2.
  DipoleTensor& add_product(double weight, Point const& a, Point const& b) {
    xx += weight * a[0] * b[0], yy += weight * a[1] * b[1], zz += weight * a[2] * b[2];
    double const half = 0.5 * weight;
    xy += half * (a[0] * b[1] + a[1] * b[0]);
    xz += half * (a[0] * b[2] + a[2] * b[0]);
    yz += half * (a[1] * b[2] + a[2] * b[1]);
    return *this;
  }
};

inline double length(Point const& a) { return std::sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]); }
inline Point add_scaled(double factor, Point const& a, Point const& b) {
  return {factor * a[0] + b[0], factor * a[1] + b[1], factor * a[2] + b[2]};
}

/// Returns the tensor at the end of the vector r from the dipole; zero for r = 0.
inline DipoleTensor dipole_tensor(Point const& r) {
  DipoleTensor sum;
  double const r2 = r[0] * r[0] + r[1] * r[1] + r[2] * r[2];
  if (r2 == 0) return sum;
  double const per_cube = 1 / (r2 * std::sqrt(r2));
  return sum.add_unit(-per_cube).add_product(3 * per_cube / r2, r, r);
}

/// The short-range part of Ewald's sum: second derivatives of erfc(alpha * r) / r, which fall off
/// like exp(-(alpha * r)^2). `unit` is the factor of the identity, and `product` that of r r^T.
struct ShortRangeDipole {
  ShortRangeDipole(double r2, double alpha) {
    double const r = std::sqrt(r2), two = 2 * alpha / std::sqrt(std::numbers::pi);
    double const gauss = two * std::exp(-alpha * alpha * r2);
    double const across = (std::erfc(alpha * r) / r + gauss) / r2;
    unit = -across;
    product = (3 * across + 2 * alpha * alpha * gauss) / r2;
  }
  double unit, product;
};
/// Ewald's sum over wave numbers contains the field of each dipole on itself. Returns the factor of
/// the identity that removes it: minus the long-range part at r = 0.
inline double self_field_of_ewald(double alpha) {
  return 4 * alpha * alpha * alpha / (3 * std::sqrt(std::numbers::pi));
}
/// Terms of Ewald's sums are below round-off at distances above ewald_reach / alpha, and at wave
/// numbers above 2 * alpha * ewald_reach.
inline constexpr double ewald_reach = 6.2;

}  // namespace cayspin::inline v0_2::detail
