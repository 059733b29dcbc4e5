// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_1::mpi {

/// Numbers of parts along y and z. Rows along x stay whole.
struct Division {
  int y = 1, z = 1;
  friend bool operator==(Division const&, Division const&) = default;
};

/// Can each part send `depth` rows or planes of its own?
inline bool can_divide(Lattice const& lattice, int depth, Division const& division) {
  auto const fits = [&](std::int64_t extent, int parts) {
    return parts == 1 || (parts > 1 && extent / parts >= depth);
  };
  return fits(lattice.shape[1], division.y) && fits(lattice.shape[2], division.z);
}

/// The division into so many parts that repeats least work; along z where two are alike.
/// Throws std::invalid_argument when there is none.
inline Division divide(Lattice const& lattice, int depth, int parts) {
  Division best{0, 0};
  double least = 0;
  for (int y = 1; y <= parts; ++y) {
    Division const division{y, parts / y};
    if (parts % y != 0 || !can_divide(lattice, depth, division)) continue;
    double const repeated =
        static_cast<double>(y - 1) / static_cast<double>(lattice.shape[1]) +
        static_cast<double>(division.z - 1) / static_cast<double>(lattice.shape[2]);
    if (best.y == 0 || repeated < least) best = division, least = repeated;
  }
  if (best.y == 0)
    throw std::invalid_argument(
        "cayspin::mpi::divide: a lattice of " + std::to_string(lattice.shape[0]) + " x " +
        std::to_string(lattice.shape[1]) + " x " + std::to_string(lattice.shape[2]) +
        " sites has no " + std::to_string(parts) + " parts of at least " + std::to_string(depth) +
        " rows or planes");
  return best;
}

/// Throws std::invalid_argument unless the division is one into `parts` parts that fit.
inline void require_division(Lattice const& lattice, int depth, Division const& division,
                             int parts) {
  if (depth < 1) throw std::invalid_argument("cayspin::mpi::Domain: the depth must be at least 1");
  if (division.y < 1 || division.z < 1 || std::int64_t{division.y} * division.z != parts)
    throw std::invalid_argument("cayspin::mpi::Domain: a division into " +
                                std::to_string(division.y) + " x " + std::to_string(division.z) +
                                " parts is not one for " + std::to_string(parts) + " ranks");
  if (!can_divide(lattice, depth, division))
    throw std::invalid_argument("cayspin::mpi::Domain: a part has fewer rows or planes than the " +
                                std::to_string(depth) + " that its neighbours need");
}

}  // namespace cayspin::inline v0_1::mpi
