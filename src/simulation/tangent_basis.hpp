// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <vector>

namespace cayspin::simulation {

/// A state, and two basis vectors of the tangent plane of each spin. Vacant sites and frozen spins
/// have none.
struct TangentBasis {
  std::vector<double> spins;       // sites x 3
  std::vector<std::size_t> sites;  // sites that have basis vectors
  std::vector<double> basis;       // two vectors for each of them

  /// `frozen`: as returned by io::frozen.
  TangentBasis(std::vector<double> numbers_of_spins, std::vector<unsigned char> const& frozen);
  std::size_t size() const { return 2 * sites.size(); }
  double const* vector(std::size_t coordinate) const { return &basis[3 * coordinate]; }
};

}  // namespace cayspin::simulation
