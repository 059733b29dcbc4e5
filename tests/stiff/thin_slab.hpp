// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/landau_lifshitz.hpp"

#include <cmath>
#include <numbers>

namespace cayspin::test {

/// A slab of thickness 1 in so many cells: its fastest spin wave is of frequency 4 cells^2.
inline Slab slab_of(std::int64_t cells, double damping) {
  return {.lattice = Lattice::chain(cells, 1 / static_cast<double>(cells)),
          .exchange = 1,
          .anisotropy = 1,
          .demag = 1,
          .applied = {0.05, 0.05, 0},
          .damping = damping};
}

template <class Field = Spins>
Field smooth_start(Lattice const& lattice) {
  return make_spins<Field>(lattice, [&](auto i, auto, auto) {
    double const u = std::numbers::pi * (i + 0.5) / static_cast<double>(lattice.shape[0]);
    return Vector{0.3 + 0.2 * std::cos(u), 0.5 + 0.1 * std::cos(2 * u), 0.8};
  });
}

}  // namespace cayspin::test
