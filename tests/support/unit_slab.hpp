// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "landau_lifshitz.hpp"

#include <numbers>

namespace cayspin::test {

/// Returns a slab of 100 spins with normal x, in which all coefficients are 1.
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

/// Returns a slab of thickness 1, divided into `cells` cells. Its fastest spin wave has a frequency
/// of about 4 * cells^2.
inline Slab thin_slab(std::int64_t cells, double damping) {
  Slab slab = unit_slab({0.05, 0.05, 0}, damping);
  slab.lattice = Lattice::chain(cells, 1 / static_cast<double>(cells));
  return slab;
}

/// Returns spins that turn a little across a slab.
template <class Field = Spins>
Field smooth_start(Lattice const& lattice) {
  return make_spins<Field>(lattice, [&](auto i, auto, auto) {
    double const u = std::numbers::pi * (i + 0.5) / static_cast<double>(lattice.shape[0]);
    return Vector{0.3 + 0.2 * std::cos(u), 0.5 + 0.1 * std::cos(2 * u), 0.8};
  });
}
inline Spins slab_start(double spacing = 1) { return smooth_start(Lattice::chain(100, spacing)); }

}  // namespace cayspin::test
