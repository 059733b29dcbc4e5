// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "../support/figures.hpp"
#include "../support/landau_lifshitz.hpp"

#include <numbers>

namespace cayspin::test {

/// A field of one length in the plane of x and y, beside a constant one.
struct Rotating {
  double amplitude = 0;
  Vector constant{0, 0, 0};
  Vector operator()(double t) const {
    return constant + Vector{amplitude * std::cos(3 * t), amplitude * std::sin(3 * t), 0};
  }
};

/// One type of generator for all: what is 0 acts on nothing.
inline auto rotating_slab(Slab const& slab, double amplitude) {
  return LandauLifshitz{EffectiveField{Exchange{slab.lattice, slab.exchange},
                                       UniaxialAnisotropy{slab.anisotropy, slab.axis},
                                       SlabDemag{Vector{1, 0, 0}, slab.demag},
                                       TimeDependentZeeman{Rotating{amplitude, slab.applied}}},
                        slab.damping};
}
using RotatingSlab = decltype(rotating_slab({}, 0));

inline Slab hard_magnet(Lattice const& lattice, double damping) {
  return {.lattice = lattice,
          .exchange = 1,
          .anisotropy = 0.8,
          .axis = {1, 2, 3},
          .demag = 0.7,
          .applied = {0.5, -0.7, 0.9},
          .damping = damping};
}

}  // namespace cayspin::test
