// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/follow.hpp"
#include "io/key.hpp"
#include "io/site_numbers.hpp"
#include "io/words.hpp"

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace cayspin::inline v0_2::io {

/// The table [lattice].
struct Lattice {
  /// nx, ny, nz; for rigid bodies count, 1, 1. For a crystal nz is basis.size() times the number of
  /// cells along z: plane k * basis.size() + s has site s of the cells with number k
  /// along z.
  std::array<std::int64_t, 3> shape = {1, 1, 1};
  Triple spacing = {1, 1, 1};
  std::array<BoundaryKind, 3> boundary = {};
  std::array<Triple, 3> cell = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};  ///< in units of spacing
  std::vector<Triple> basis = {{0, 0, 0}};    ///< in fractions of the cell's vectors
  std::vector<double> moments, gyromagnetic;  ///< one for each site of the cell; empty: all 1
  SiteNumbers moments_of_sites;               ///< if set, replace `moments`; 0: no spin
  SiteNumbers gyromagnetic_of_sites;          ///< if set, replace `gyromagnetic`
  SiteNumbers occupied, frozen;  ///< true where not 0; default: all occupied, none frozen
  SiteNumbers regions;           ///< whole numbers, starting at 0
  std::optional<Follow> follow;
};

}  // namespace cayspin::inline v0_2::io
