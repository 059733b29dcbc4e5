// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <array>
#include <cstdint>

namespace cayspin::inline v0_2::io::detail {

/// Voronoi grains of a lattice: a point belongs to the nearest seed. Each tile of the lattice has
/// one seed at a random position. Grains wrap around where the lattice is periodic. They do not
/// depend on which part of the lattice is evaluated.
class Grains {
 public:
  /// `length`: converts lattice.spacing to the unit of `size` below.
  Grains(Lattice const& lattice, double length);

  /// Returns the number 0, 1, .. of the grain at a point. `point`: in fractions of the lattice. The
  /// lattice is divided into tiles with edges of about `size`, and each tile has one grain. An axis
  /// shorter than 1.5 * size is not divided: grains are columns along it. Throws std::runtime_error
  /// for an invalid size or seed, and for more than 2^53 grains.
  double at(std::array<double, 3> const& point, double size, double seed) const;

 private:
  std::array<Triple, 3> edges_;  ///< of the whole lattice
  std::array<double, 3> lengths_, heights_;
  std::array<bool, 3> periodic_;
};

}  // namespace cayspin::inline v0_2::io::detail
