// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "landau_lifshitz.hpp"

#include <numbers>

namespace cayspin::test {

/// 100 spins across a slab with normal x, all coefficients 1.
inline Slab unit_slab(Vector const& applied, double damping, bool precession = true,
                      Vector const& axis = {0, 0, 1}, double spacing = 1) {
  return {.lattice = Lattice::chain(100, spacing),
          .exchange = 1,
          .anisotropy = 1,
          .axis = axis,
          .demag = 1,
          .applied = applied,
          .damping = damping,
          .precession = precession};
}

inline Spins slab_start(double spacing = 1) {
  return make_spins(Lattice::chain(100, spacing), [](auto i, auto, auto) {
    double const u = std::numbers::pi * (i + 0.5) / 100;
    return Vector{0.3 + 0.2 * std::cos(u), 0.5 + 0.1 * std::cos(2 * u), 0.8};
  });
}

}  // namespace cayspin::test
