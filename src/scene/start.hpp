// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace cayspin::inline v0_1::io::detail {

/// v/|v|; nothing when v is zero or not finite. Scaling by a power of two is exact and keeps |v|^2
/// from overflowing or underflowing.
inline std::optional<std::array<double, 3>> normalise(std::array<double, 3> const& v) {
  if (!std::isfinite(v[0]) || !std::isfinite(v[1]) || !std::isfinite(v[2])) return std::nullopt;
  double const largest = std::max({std::abs(v[0]), std::abs(v[1]), std::abs(v[2])});
  if (largest == 0) return std::nullopt;
  int const exponent = -std::ilogb(largest);
  double const x = std::scalbn(v[0], exponent);
  double const y = std::scalbn(v[1], exponent);
  double const z = std::scalbn(v[2], exponent);
  double const norm = std::sqrt(x * x + y * y + z * z);
  return std::array<double, 3>{x / norm, y / norm, z / norm};
}

}  // namespace cayspin::inline v0_1::io::detail
