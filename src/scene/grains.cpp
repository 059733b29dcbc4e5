// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "grains.hpp"

#include "random_bits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace cayspin::inline v0_2::io::detail {
namespace {

double square(double x) { return x * x; }

/// Search for the seed nearest to a point. Each tile has one seed.
struct Search {
  std::array<std::int64_t, 3> tiles;
  std::array<Triple, 3> edges;    // of a tile
  std::array<double, 3> heights;  // of a tile, between its faces
  std::array<bool, 3> periodic;
  std::array<double, 3> point;  // in units of tiles
  std::uint64_t seed;
  // Square of the distance to the nearest seed so far.
  double nearest = std::numeric_limits<double>::infinity();
  std::int64_t grain = 0;

  /// Searches a row of tiles (axis 0), a plane (1) or all of them (2), from the point outwards, as
  /// long as they may contain a nearer seed.
  void look(std::size_t axis, std::array<std::int64_t, 3>& tile) {
    if (tiles[axis] == 1) return look_into(axis, tile, 0);
    auto const middle = std::min(static_cast<std::int64_t>(point[axis]), tiles[axis] - 1);
    for (std::int64_t away = 0, reached = 1; reached > 0; ++away) {
      reached = 0;
      for (auto const at : {middle + away, middle - away}) {
        if (away == 0 && reached > 0) break;
        double const gap = std::max({0.0, static_cast<double>(at) - point[axis],
                                     point[axis] - static_cast<double>(at + 1)});
        if (square(gap * heights[axis]) > nearest) continue;
        if (!periodic[axis] && (at < 0 || at >= tiles[axis])) continue;
        ++reached;
        look_into(axis, tile, at);
      }
    }
  }

  void look_into(std::size_t axis, std::array<std::int64_t, 3>& tile, std::int64_t at) {
    tile[axis] = at;
    if (axis > 0)
      look(axis - 1, tile);
    else
      compare(tile);
  }

  void compare(std::array<std::int64_t, 3> const& tile) {
    std::int64_t number = 0;
    for (std::size_t axis = 3; axis-- > 0;)
      number = number * tiles[axis] + (tile[axis] % tiles[axis] + tiles[axis]) % tiles[axis];
    Triple away{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (tiles[axis] == 1) continue;
      auto const counter = 3 * static_cast<std::uint64_t>(number) + axis;
      double const along =
          static_cast<double>(tile[axis]) + random_number(seed, counter) - point[axis];
      for (std::size_t c = 0; c < 3; ++c) away[c] += along * edges[axis][c];
    }
    double const squared = cayspin::detail::scalar_product(away, away);
    if (!(squared < nearest)) return;
    nearest = squared;
    grain = number;
  }
};

}  // namespace

Grains::Grains(Lattice const& lattice, double length) {
  auto const sites = static_cast<std::int64_t>(lattice.basis.size());
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const cells = static_cast<double>(lattice.shape[axis] / (axis == 2 ? sites : 1));
    for (std::size_t c = 0; c < 3; ++c)
      edges_[axis][c] = cells * lattice.cell[axis][c] * lattice.spacing[c] * length;
    periodic_[axis] = lattice.boundary[axis] == BoundaryKind::periodic;
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    auto const across =
        cayspin::detail::vector_product(edges_[(axis + 1) % 3], edges_[(axis + 2) % 3]);
    lengths_[axis] = std::sqrt(cayspin::detail::scalar_product(edges_[axis], edges_[axis]));
    heights_[axis] = std::abs(cayspin::detail::scalar_product(edges_[axis], across)) /
                     std::sqrt(cayspin::detail::scalar_product(across, across));
  }
}

double Grains::at(std::array<double, 3> const& point, double size, double seed) const {
  if (!(size > 0) || !std::isfinite(size))
    throw std::runtime_error(fmt::format("grain of size {}; accepted: a size > 0", size));
  Search search;
  search.seed = random_bits(whole_seed(seed, "grain"), 0);
  search.periodic = periodic_;
  double all = 1;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    double const tiles = std::max(1.0, std::floor(lengths_[axis] / size + 0.5));
    if (!((all *= tiles) <= 0x1p53))
      throw std::runtime_error(
          fmt::format("grain of size {}: more than 2^53 grains; accepted: a larger size", size));
    search.tiles[axis] = static_cast<std::int64_t>(tiles);
    for (std::size_t c = 0; c < 3; ++c) search.edges[axis][c] = edges_[axis][c] / tiles;
    search.heights[axis] = heights_[axis] / tiles;
    search.point[axis] = point[axis] * tiles;
  }
  std::array<std::int64_t, 3> tile;
  search.look(2, tile);
  return static_cast<double>(search.grain);
}

}  // namespace cayspin::inline v0_2::io::detail
