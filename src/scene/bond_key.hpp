// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <utility>

namespace cayspin::inline v0_2::io {

/// Identifies a bond: its two sites of the cell, and the offset from the cell of the first site to
/// that of the second.
using BondKey = std::pair<std::array<int, 2>, std::array<int, 3>>;

/// Returns the same bond seen from its other end.
inline BondKey reversed(BondKey const& key) {
  auto const& [between, offset] = key;
  return {{between[1], between[0]}, {-offset[0], -offset[1], -offset[2]}};
}

}  // namespace cayspin::inline v0_2::io
