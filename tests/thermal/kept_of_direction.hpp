// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cmath>

namespace cayspin::test {

/// Returns the average of m.m_0 after half a step's noise, with u = damping * T * dt and
/// s^2 = u - u^2 / 12. Among 32 equally likely cases, 12 leave a spin as it is, 12 turn it by
/// 2 * s, and 8 by sqrt(6) * s.
inline double kept_of_direction(double u) {
  auto const kept_by = [](double angle) { return (1 + 2 * std::cos(angle)) / 3; };
  double const s = std::sqrt(u - u * u / 12);
  return (12 + 12 * kept_by(2 * s) + 8 * kept_by(std::sqrt(6.0) * s)) / 32;
}

}  // namespace cayspin::test
