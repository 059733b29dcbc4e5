// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <array>
#include <cstdint>

namespace cayspin::inline v0_1::io::detail {

/// Voronoi grains of a lattice: a point belongs to the nearest of the seeds, of which each tile of
/// the lattice has one, anywhere in it. They close on themselves where the lattice does. Any part
/// of the lattice has the same ones.
class Grains {
 public:
  /// `length`: of the unit of lattice.spacing, in that of sizes.
  Grains(Lattice const& lattice, double length);

  /// The number 0, 1, .. of the grain at a point, in fractions of the lattice. There are as many
  /// grains as tiles of about `size` along each axis, one along an axis shorter than 1.5 sizes,
  /// where they are columns. Throws std::runtime_error for a size or a seed that makes no sense.
  double at(std::array<double, 3> const& point, double size, double seed) const;

 private:
  std::array<Triple, 3> edges_;  ///< of the whole lattice
  std::array<double, 3> lengths_, heights_;
  std::array<bool, 3> periodic_;
};

}  // namespace cayspin::inline v0_1::io::detail
