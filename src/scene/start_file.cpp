// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "start_file.hpp"

#include "dataset_of_sites.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/ovf.hpp"
#include "io/trajectory.hpp"
#include "trajectory/stored_spins.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <stdexcept>

namespace cayspin::inline v0_1::io::detail {
namespace {

void require_nodes(OvfMesh const& mesh, std::filesystem::path const& path,
                   std::array<std::int64_t, 3> const& shape) {
  if (mesh.nodes == shape) return;
  throw std::runtime_error(fmt::format("{}: its mesh has {} nodes; accepted: {}, the lattice's",
                                       path.string(), fmt::join(mesh.nodes, " x "),
                                       fmt::join(shape, " x ")));
}

void refuse_crystals(Lattice const& lattice, std::filesystem::path const& path) {
  if (lattice.basis.size() > 1)
    throw std::runtime_error(
        fmt::format("{}: OVF has one spin in a cell, and lattice.basis {}; "
                    "accepted: HDF5",
                    path.string(), lattice.basis.size()));
}

std::int64_t sites_of(Lattice const& lattice) {
  return static_cast<std::int64_t>(lattice.basis.size());
}

/// /spins (site, nz, ny, nx, 3) of a crystal: a state, without frames.
DatasetOfSites open_state(std::filesystem::path const& path, Lattice const& lattice) {
  DatasetOfSites state(path, "/spins", lattice, 3);
  if (!state.fits()) state.refuse_extents(fmt::format("({0}) or (frame, {0})", state.expected()));
  return state;
}

bool is_state_of_crystal(std::filesystem::path const& path, Lattice const& lattice) {
  return lattice.basis.size() > 1 && RealDataset(path, "/spins").extents().size() != 6;
}

}  // namespace

void check_start_file(std::filesystem::path const& path, Lattice const& lattice) {
  if (is_ovf(path)) {
    refuse_crystals(lattice, path);
    require_nodes(read_ovf_mesh(path), path, lattice.shape);
  } else {
    try_reading(path, [&] {
      if (is_state_of_crystal(path, lattice))
        open_state(path, lattice);
      else
        StoredSpins(path, lattice.shape, sites_of(lattice));
    });
  }
}

std::vector<double> read_start_file(std::filesystem::path const& path, Lattice const& lattice,
                                    SiteBox const& box) {
  if (!is_ovf(path)) {
    if (read_guarded(path, [&] { return is_state_of_crystal(path, lattice); }))
      return read_guarded(path, [&] { return open_state(path, lattice).in(box); });
    return read_spins(path, lattice.shape, box, sites_of(lattice));
  }
  refuse_crystals(lattice, path);
  require_nodes(read_ovf_mesh(path), path, lattice.shape);
  return numbers_in(box, lattice.shape, 3, read_ovf(path).values);
}

std::vector<double> sites_with_spins(std::filesystem::path const& path, Lattice const& lattice,
                                     SiteBox const& box) {
  auto const spins = read_start_file(path, lattice, box);
  std::vector<double> there(spins.size() / 3);
  for (std::size_t site = 0; site < there.size(); ++site) {
    auto const* const m = &spins[3 * site];
    there[site] = m[0] == 0 && m[1] == 0 && m[2] == 0 ? 0 : 1;
  }
  return there;
}

bool holds_spins(std::filesystem::path const& path) {
  if (is_ovf(path)) return true;
  return read_guarded(path, [&] {
    QuietErrors const quiet;
    auto const file = open_file(path);
    auto const has = [&](char const* name) { return H5Lexists(file.get(), name, H5P_DEFAULT) > 0; };
    return has("/spins") && !has("/values");
  });
}

}  // namespace cayspin::inline v0_1::io::detail
