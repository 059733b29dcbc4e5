// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/lattice.hpp>

#include <algorithm>
#include <cstdint>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_2::mpi {

/// Numbers of parts along y and z. Rows along x are not divided.
struct Division {
  int y = 1, z = 1;
  friend bool operator==(Division const&, Division const&) = default;
};

/// Numbers of ghost rows along y and ghost planes along z that a part has at the border to each
/// neighbour.
struct Depth {
  int y, z;
  Depth(int of_both) : y(of_both), z(of_both) {}
  Depth(int rows, int planes) : y(rows), z(planes) {}
  friend bool operator==(Depth const&, Depth const&) = default;
};

/// Rounds the depth along z up to whole cells of a crystal; a cell has one plane for each of its
/// sites.
inline Depth in_whole_cells(Depth const& depth, Lattice const& lattice) {
  auto const of_cell = static_cast<int>(lattice.cell_sites);
  return {depth.y, (depth.z + of_cell - 1) / of_cell * of_cell};
}

/// Returns true if each part has at least the rows and planes that its neighbours need for ghosts.
inline bool can_divide(Lattice const& lattice, Depth const& depth, Division const& division) {
  auto const fits = [](std::int64_t extent, int needed, int parts) {
    return parts == 1 || (parts > 1 && extent / parts >= needed);
  };
  auto const of_cell = lattice.cell_sites;
  return fits(lattice.shape[1], depth.y, division.y) &&
         fits(lattice.shape[2] / of_cell,
              static_cast<int>(in_whole_cells(depth, lattice).z / of_cell), division.z);
}

/// Returns the depth as text for a message, such as "1 row or 2 planes".
inline std::string to_text(Depth const& depth) {
  auto const* const row = depth.y == 1 ? " row" : " rows";
  auto const* const plane = depth.z == 1 ? " plane" : " planes";
  if (depth.y == depth.z) return std::to_string(depth.y) + row + " or" + plane;
  return std::to_string(depth.y) + row + " or " + std::to_string(depth.z) + plane;
}

/// Returns the division into this many parts with the fewest ghosts inside the lattice; of equally
/// good ones, the one with the most parts along z. Throws std::invalid_argument when no division is
/// possible.
inline Division divide(Lattice const& lattice, Depth const& depth, int parts) {
  auto const in_cells = in_whole_cells(depth, lattice);
  Division best{0, 0};
  double least = 0;
  for (int y = 1; y <= parts; ++y) {
    Division const division{y, parts / y};
    if (parts % y != 0 || !can_divide(lattice, depth, division)) continue;
    auto const share = [](int needed, int along, std::int64_t extent) {
      return static_cast<double>(needed) * (along - 1) / static_cast<double>(extent);
    };
    double const ghosts = share(in_cells.y, division.y, lattice.shape[1]) +
                          share(in_cells.z, division.z, lattice.shape[2]);
    if (best.y == 0 || ghosts < least) best = division, least = ghosts;
  }
  if (best.y == 0)
    throw std::invalid_argument(
        "cayspin::mpi::divide: a lattice of " + std::to_string(lattice.shape[0]) + " x " +
        std::to_string(lattice.shape[1]) + " x " + std::to_string(lattice.shape[2]) +
        " sites has no " + std::to_string(parts) + " parts of at least " + to_text(in_cells));
  return best;
}

/// Throws std::invalid_argument unless the depth is positive and the division gives `parts` parts
/// that are large enough for this depth.
inline void require_division(Lattice const& lattice, Depth const& depth, Division const& division,
                             int parts) {
  if (depth.y < 1 || depth.z < 1)
    throw std::invalid_argument("cayspin::mpi::Domain: the depth must be at least 1");
  if (division.y < 1 || division.z < 1 || std::int64_t{division.y} * division.z != parts)
    throw std::invalid_argument("cayspin::mpi::Domain: a division into " +
                                std::to_string(division.y) + " x " + std::to_string(division.z) +
                                " parts is not one for " + std::to_string(parts) + " ranks");
  if (!can_divide(lattice, depth, division))
    throw std::invalid_argument("cayspin::mpi::Domain: a part has fewer than the " +
                                to_text(in_whole_cells(depth, lattice)) +
                                " that its neighbours need");
}

}  // namespace cayspin::inline v0_2::mpi
