// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cmath>
#include <numeric>

namespace cayspin::test {

/// A spin wave of two sublattices, one along the axis of the anisotropy and one opposite to it.
/// Both turn rigidly about the axis in opposite phases, at any opening angle.
struct AntiferromagneticCone {
  double smaller;    ///< the sine of the angle of the sublattice that opens less
  double frequency;  ///< right-handed about the spins that open more

  /// Returns the wave in which the sublattice that opens more has the angle `opening`. At
  /// equilibrium each sublattice exerts the field `exchange` on the other. The wave multiplies the
  /// part of this field that is normal to the axis by gamma in (0, 1]. `anisotropy` is on-site.
  static AntiferromagneticCone of(double exchange, double anisotropy, double gamma,
                                  double opening) {
    double const sin_a = std::sin(opening), cos_a = std::cos(opening), wave = exchange * gamma;
    // The components of field and spin normal to the axis are collinear, so each sublattice turns
    // rigidly about the axis, at this rate.
    auto const rate_a = [&](double b) {
      return exchange * std::cos(b) + anisotropy * cos_a - wave * std::sin(b) * cos_a / sin_a;
    };
    auto const rate_b = [&](double b) {
      return -exchange * cos_a - anisotropy * std::cos(b) +
             wave * sin_a * std::cos(b) / std::sin(b);
    };
    double low = 0, high = opening;
    for (int halving = 0; halving < 200; ++halving) {
      double const b = std::midpoint(low, high);
      (rate_b(b) > rate_a(b) ? low : high) = b;
    }
    return {std::sin(low), rate_a(low)};
  }

  /// Returns the frequency at small openings.
  static double of_small_opening(double exchange, double anisotropy, double gamma) {
    return std::sqrt(std::pow(exchange + anisotropy, 2) - std::pow(exchange * gamma, 2));
  }
};

}  // namespace cayspin::test
