// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "ovf_of_sites.hpp"

#include "io/ovf.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

namespace cayspin::inline v0_2::io::detail {

void check_ovf_of_sites(std::filesystem::path const& path, Lattice const& lattice,
                        std::int64_t components) {
  if (lattice.basis.size() > 1)
    throw std::runtime_error(
        fmt::format("{}: OVF has one {} per cell, and lattice.basis has {}; accepted: HDF5",
                    path.string(), components == 3 ? "spin" : "value", lattice.basis.size()));
  auto const mesh = read_ovf_mesh(path, components);
  if (mesh.nodes == lattice.shape) return;
  throw std::runtime_error(fmt::format("{}: its mesh has {} nodes; accepted: {}, the lattice's",
                                       path.string(), fmt::join(mesh.nodes, " x "),
                                       fmt::join(lattice.shape, " x ")));
}

std::vector<double> read_ovf_of_sites(std::filesystem::path const& path, Lattice const& lattice,
                                      std::int64_t components, SiteBox const& box) {
  check_ovf_of_sites(path, lattice, components);
  return numbers_in(box, lattice.shape, components, read_ovf(path, components).values);
}

}  // namespace cayspin::inline v0_2::io::detail
