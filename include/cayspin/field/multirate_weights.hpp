// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <span>

// Weights that interpolate values of an expensive field to a time x within a step, 0 <= x <= 1.
namespace cayspin::inline v0_2::detail {

inline constexpr std::size_t most_multirate_values = 5;
using MultirateWeights = std::array<double, most_multirate_values>;

/// Returns weights for values at `nodes`: the weighted sum is the value at x of the polynomial
/// through these values.
inline MultirateWeights interpolating_weights(double x, std::span<double const> nodes) {
  MultirateWeights weights{};
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    weights[i] = 1;
    for (std::size_t j = 0; j < nodes.size(); ++j)
      if (j != i) weights[i] *= (x - nodes[j]) / (nodes[i] - nodes[j]);
  }
  return weights;
}

/// Returns the value at x of a polynomial of degree 2 with this mean over the step. `slope`: the
/// derivative in the middle of the step. `curvature`: half the second derivative. The mean
/// determines the order of a method; slope and curvature affect only its stability.
inline double with_mean(double mean, double slope, double curvature, double x) {
  return mean + slope * (x - 0.5) + curvature * (x * x - x + 1.0 / 6);
}

// Polynomials for Multirate of order 4. A mode that makes half a turn per step cannot be told from
// one that turns the other way, and the polynomial of degree 3 through the last values amplifies
// both. The polynomials below satisfy the conditions of order 4: they interpolate exactly to degree
// 1 (predictor) or 2 (corrector), and the factor of the next difference (`second` or `third`) has
// the right mean. Their other 10 numbers come from a search over linear modes
// m' = (i - damping) * (w + D) * m, where D is the expensive field and w the rest. D may differ
// between the two directions normal to the spin. The chosen numbers allow long steps at which no
// such mode grows, and change linewidths little.

/// Returns the predictor's weights of the values at x = 0, -1, -2, -3.
inline MultirateWeights damping_predictor(double x, std::span<double const> /*nodes*/) {
  double const second = with_mean(5.0 / 12, -6.58, -0.91, x);
  double const third = with_mean(-0.23, 4.19, 1.32, x);
  return {1 + x + second + third, -x - 2 * second - 3 * third, second + 3 * third, -third, 0};
}

/// Returns the corrector's weights of the values at x = 1, 0, -1, -2, -3.
inline MultirateWeights damping_corrector(double x, std::span<double const> /*nodes*/) {
  double const third = with_mean(-1.0 / 24, 0.77, -4.61, x);
  double const fourth = with_mean(0.06, -0.41, 1.8, x);
  return {0.5 * x * (x + 1) + third + fourth, 1 - x * x - 3 * third - 4 * fourth,
          0.5 * x * (x - 1) + 3 * third + 6 * fourth, -third - 4 * fourth, fourth};
}

}  // namespace cayspin::inline v0_2::detail
