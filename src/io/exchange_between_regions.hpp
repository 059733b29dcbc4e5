// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstdint>

namespace cayspin::inline v0_2::io {

/// A factor on the exchange of bonds between two regions.
struct ExchangeBetween {
  std::array<std::int64_t, 2> regions = {};
  double factor = 1;
};

/// E = -J * m.m' - B * (m.m')^2 across each face between two regions, with J and B per area. m and
/// m' are the spins at the two sides of the face. If Field::exchange_at_faces is set, they differ
/// from the spins at the centres of the cells, because exchange turns a spin between the centre and
/// the face.
struct Interlayer {
  std::array<std::int64_t, 2> regions = {};
  double bilinear = 0, biquadratic = 0;  ///< J, B
  std::int64_t range = 0;                ///< number of cells without a spin between m and m'
};

}  // namespace cayspin::inline v0_2::io
