// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "equal_bits.hpp"

#include <cmath>
#include <vector>

namespace cayspin::test {

/// Odd ones, and such with long rows, which a sweep cuts into many blocks.
inline std::vector<Lattice> swept_lattices() {
  auto lattices = odd_lattices();
  std::array<std::int64_t, 3> const wide[] = {{2003, 41, 3}, {3001, 53, 1}, {1003, 17, 13}};
  for (auto const& shape : wide)
    for (Boundary const b : {Boundary::open, Boundary::periodic})
      lattices.push_back({shape, {1, 0.9, 1.1}, {b, b, b}});
  lattices.push_back(
      {{301, 37, 5}, {1, 1, 1}, {Boundary::open, Boundary::periodic, Boundary::open}});
  lattices.push_back(
      {{301, 5, 37}, {1, 1, 1}, {Boundary::periodic, Boundary::open, Boundary::periodic}});
  return lattices;
}

/// Those that methods of many stages can take in a test.
inline std::vector<Lattice> smaller_swept_lattices() {
  auto lattices = swept_lattices();
  std::erase_if(lattices, [](Lattice const& lattice) { return lattice.sites() > 60000; });
  return lattices;
}

inline bool can_sweep(Lattice const& lattice, int stages) {
  auto const rows = lattice.shape[1];
  return lattice.boundary[1] == Boundary::open || rows == 1 || rows >= stages;
}

/// Every term, and a field that turns.
inline auto turning(Slab const& slab) {
  return LandauLifshitz(EffectiveField(Exchange(slab.lattice, slab.exchange),
                                       UniaxialAnisotropy(slab.anisotropy, slab.axis),
                                       TimeDependentZeeman([](double t) {
                                         return Vec3<double>{std::cos(t), std::sin(t), 0.3};
                                       })),
                        slab.damping);
}

}  // namespace cayspin::test
