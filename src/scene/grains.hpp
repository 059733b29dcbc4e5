// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <array>
#include <cstdint>

namespace cayspin::inline v0_2::io::detail {

/// Voronoi grains of a lattice: a point belongs to the nearest seed. Each tile of the lattice has
/// one seed at a random position. Grains wrap around where the lattice is periodic. They do not
/// depend on the part of the lattice that is evaluated.
class Grains {
 public:
  /// `length`: the unit of lattice.spacing, in the unit of sizes.
  Grains(Lattice const& lattice, double length);

  /// Returns the number 0, 1, .. of the grain at a point, in fractions of the lattice. There are as
  /// many grains as tiles of about `size` along each axis; along an axis shorter than 1.5 sizes
  /// there is one, so that grains are columns. Throws std::runtime_error for an invalid size or
  /// seed.
  double at(std::array<double, 3> const& point, double size, double seed) const;

 private:
  std::array<Triple, 3> edges_;  ///< of the whole lattice
  std::array<double, 3> lengths_, heights_;
  std::array<bool, 3> periodic_;
};

}  // namespace cayspin::inline v0_2::io::detail
