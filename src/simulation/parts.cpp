// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "parts.hpp"

#include "failure.hpp"
#include "io/scene.hpp"

#include <cayspin/field/bonds_of_sites.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>

namespace cayspin::simulation {

mpi::Depth depth_of_parts(io::Scene const& scene, cayspin::Lattice const& lattice, int ghosts) {
  mpi::Depth depth(ghosts);
  if (io::needs_pass(scene)) {
    cayspin::detail::BondLists const bonds(lattice, io::couplings(scene));
    auto const [rows, cells] = bonds.rows_and_cells();
    depth.y = std::max(depth.y, rows);
    depth.z = std::max(depth.z, cells * static_cast<int>(lattice.cell_sites));
    for (auto const& bond : scene.field.interlayers) {
      if (bond.range == 0) continue;
      auto const reach = bond.range + 1;
      if (reach < lattice.shape[1]) depth.y = std::max(depth.y, static_cast<int>(reach));
      if (reach < lattice.shape[2]) depth.z = std::max(depth.z, static_cast<int>(reach));
    }
  }
  return mpi::in_whole_cells(depth, lattice);
}

std::array<int, 2> read_parts(std::string const& text, cayspin::Lattice const& lattice,
                              mpi::Depth const& depth) {
  std::array<int, 2> parts{0, 0};
  int end = 0;
  if (std::sscanf(text.c_str(), "%d,%d%n", &parts[0], &parts[1], &end) != 2 ||
      static_cast<std::size_t>(end) != text.size() || parts[0] < 1 || parts[1] < 1)
    throw UsageError(fmt::format("--ranks {}: accepted: two numbers, such as 1,4", text));
  if (!mpi::can_divide(lattice, depth, {.y = parts[0], .z = parts[1]}))
    throw UsageError(
        fmt::format("--ranks {}: accepted: numbers of parts along y and z, of at least {} each",
                    text, mpi::to_text(depth)));
  return parts;
}

double repeated_share(cayspin::Lattice const& lattice, int ghosts,
                      std::array<int, 2> const& parts) {
  // Extents along y and z of a part in the middle of the lattice, and how many of its ends along
  // each axis are inside the lattice.
  std::array<double, 2> extent{}, ends{};
  for (std::size_t i = 0; i < 2; ++i) {
    extent[i] = static_cast<double>(lattice.shape[i + 1]) / parts[i];
    bool const closed = lattice.boundary[i + 1] == cayspin::Boundary::periodic;
    ends[i] = parts[i] == 1 ? 0 : parts[i] == 2 && !closed ? 1 : 2;
  }
  double work = 0;
  for (int further = 0; further < ghosts; ++further)
    work += (extent[0] + ends[0] * further) * (extent[1] + ends[1] * further);
  return work / (ghosts * extent[0] * extent[1]) - 1;
}

}  // namespace cayspin::simulation
