// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cayspin/cayspin.hpp>
#include <cayspin/mpi/domain.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace cayspin::test {

inline int ranks() {
  int size = 0;
  MPI_Comm_size(MPI_COMM_WORLD, &size);
  return size;
}

/// Returns all divisions of a lattice among the available ranks.
inline std::vector<mpi::Division> divisions(Lattice const& lattice, int depth) {
  std::vector<mpi::Division> found;
  for (int y = 1; y <= ranks(); ++y)
    if (mpi::Division const one{y, ranks() / y};
        ranks() % y == 0 && mpi::can_divide(lattice, depth, one))
      found.push_back(one);
  return found;
}

/// Returns lattices with irregular and small extents; each boundary is open in some, periodic in
/// others.
inline std::vector<Lattice> lattices() {
  std::vector<Lattice> all;
  std::array<std::int64_t, 3> const shapes[] = {
      {13, 17, 19}, {1, 1, 41}, {5, 33, 1}, {35, 10, 12}, {3, 2, 16}};
  for (auto const& shape : shapes)
    for (int const bits : {0, 3, 6}) {
      auto const boundary = [&](int axis) {
        return bits >> axis & 1 ? Boundary::periodic : Boundary::open;
      };
      all.push_back({shape, {1, 0.9, 1.1}, {boundary(0), boundary(1), boundary(2)}});
    }
  return all;
}

inline std::string name_of(Lattice const& lattice, mpi::Division const& division) {
  std::string name;
  for (std::size_t axis = 0; axis < 3; ++axis)
    name += std::to_string(lattice.shape[axis]) +
            (lattice.boundary[axis] == Boundary::periodic ? "p " : " ");
  return name + "in " + std::to_string(division.y) + " x " + std::to_string(division.z) + " parts";
}

/// From the values (sites, 3) of the whole lattice, returns those of the part's own sites.
inline std::vector<double> numbers_of_part(Lattice const& local, std::vector<double> const& all) {
  auto const& shape = whole(local).shape;
  auto const begin = local.part->begin();
  std::vector<double> numbers;
  for (std::int64_t z = 0; z < local.own(2); ++z)
    for (std::int64_t y = 0; y < local.own(1); ++y) {
      auto const row = (begin[2] + local.ghosts[2].before + z) * shape[1] + begin[1] +
                       local.ghosts[1].before + y;
      auto const first = all.begin() + 3 * row * shape[0];
      numbers.insert(numbers.end(), first, first + 3 * shape[0]);
    }
  return numbers;
}

}  // namespace cayspin::test
