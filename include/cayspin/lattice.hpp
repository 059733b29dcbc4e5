// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <string>

namespace cayspin::inline v0_2 {

/// open: a missing neighbour contributes nothing (Neumann). periodic: the axis wraps around.
enum class Boundary { open, periodic };

class Part;  // part.hpp

/// Numbers of rows or planes at the two ends of an axis that belong to other parts of a larger
/// lattice.
struct Ghosts {
  std::int64_t before = 0, after = 0;
  friend bool operator==(Ghosts const&, Ghosts const&) = default;
};

/// A rectangular lattice of sites in one, two or three dimensions. Sites are numbered with the x
/// index varying fastest. Along an axis of extent 1, even a periodic one, sites have no neighbours;
/// along a periodic axis of extent 2, the other site is both neighbours of a site.
struct Lattice {
  std::array<std::int64_t, 3> shape{1, 1, 1};
  std::array<double, 3> spacing{1, 1, 1};
  std::array<Boundary, 3> boundary{Boundary::open, Boundary::open, Boundary::open};
  /// Ghosts along y and z of a part of a larger lattice (mpi::Domain), included in `shape`.
  std::array<Ghosts, 3> ghosts{};
  Part const* part = nullptr;
  /// Sites per cell of a crystal (crystal.hpp): successive planes along z hold the sites of a cell
  /// in turn.
  std::int64_t cell_sites = 1;
  /// Number of independent copies of the lattice in one field. They follow each other along z, and
  /// `shape` is the shape of one copy. No term sees a spin of another replica.
  std::int64_t replicas = 1;

  static Lattice chain(std::int64_t nx, double spacing = 1, Boundary boundary = Boundary::open) {
    return {{nx, 1, 1}, {spacing, spacing, spacing}, {boundary, boundary, boundary}};
  }
  static Lattice square(std::int64_t nx, std::int64_t ny, double spacing = 1,
                        Boundary boundary = Boundary::open) {
    return {{nx, ny, 1}, {spacing, spacing, spacing}, {boundary, boundary, boundary}};
  }
  static Lattice cubic(std::int64_t nx, std::int64_t ny, std::int64_t nz, double spacing = 1,
                       Boundary boundary = Boundary::open) {
    return {{nx, ny, nz}, {spacing, spacing, spacing}, {boundary, boundary, boundary}};
  }

  /// Returns this lattice with `count` replicas.
  Lattice with_replicas(std::int64_t count) const {
    Lattice lattice = *this;
    lattice.replicas = count;
    return lattice;
  }

  /// Returns the number of sites of all replicas, without ghosts.
  std::int64_t sites() const { return own(0) * own(1) * own(2) * replicas; }
  bool has_neighbors(int axis) const { return shape[static_cast<std::size_t>(axis)] > 1; }

  /// Returns the extent along an axis without ghosts.
  std::int64_t own(std::size_t axis) const {
    return shape[axis] - ghosts[axis].before - ghosts[axis].after;
  }

  friend bool operator==(Lattice const&, Lattice const&) = default;

  /// Throws std::invalid_argument for an invalid extent or spacing, an invalid number of ghosts, of
  /// sites in a cell or of replicas, replicas of a part of a lattice, and more than 1e15 sites. The
  /// message names the first fault.
  void validate() const {
    constexpr std::int64_t most_extent = std::numeric_limits<std::int32_t>::max() / 4;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      std::string const which(1, "xyz"[axis]);
      if (shape[axis] < 1 || shape[axis] > most_extent)
        throw std::invalid_argument("cayspin::Lattice: the extent along " + which + " is " +
                                    std::to_string(shape[axis]) + "; it must be 1 .. 536870911");
      if (!(spacing[axis] > 0) || !std::isfinite(spacing[axis]))
        throw std::invalid_argument("cayspin::Lattice: the spacing along " + which +
                                    " must be positive and finite");
      auto const& [before, after] = ghosts[axis];
      if (before < 0 || after < 0 || before + after >= shape[axis] || (axis == 0 && before + after))
        throw std::invalid_argument("cayspin::Lattice: the ghosts along " + which +
                                    " leave no sites of the part's own");
    }
    if (cell_sites < 1)
      throw std::invalid_argument("cayspin::Lattice: a cell has " + std::to_string(cell_sites) +
                                  " sites; it must have at least 1");
    if (part == nullptr && shape[2] % cell_sites != 0)
      throw std::invalid_argument("cayspin::Lattice: the extent along z is " +
                                  std::to_string(shape[2]) + "; it must be a multiple of the " +
                                  std::to_string(cell_sites) + " sites of a cell");
    if (replicas < 1 || replicas > most_extent / shape[2])
      throw std::invalid_argument(
          "cayspin::Lattice: the number of replicas is " + std::to_string(replicas) +
          "; it must be at least 1, and with the extent along z at most 536870911");
    if (replicas > 1 && part != nullptr)
      throw std::invalid_argument("cayspin::Lattice: a part of a lattice has no replicas");
    if (static_cast<double>(shape[0]) * static_cast<double>(shape[1]) *
            static_cast<double>(shape[2]) * static_cast<double>(replicas) >
        1e15)
      throw std::invalid_argument("cayspin::Lattice: more than 1e15 sites");
  }
};

}  // namespace cayspin::inline v0_2
