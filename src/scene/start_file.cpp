// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "start_file.hpp"

#include "hdf5/survives.hpp"
#include "trajectory/stored_spins.hpp"

#include <cayspin/io/ovf.hpp>
#include <cayspin/io/trajectory.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

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

}  // namespace

void check_start_file(std::filesystem::path const& path, std::array<std::int64_t, 3> const& shape) {
  if (is_ovf(path))
    require_nodes(read_ovf_mesh(path), path, shape);
  else
    try_in_child(path, [&] { StoredSpins(path, shape); });
}

std::vector<double> read_start_file(std::filesystem::path const& path,
                                    std::array<std::int64_t, 3> const& shape, SiteBox const& box) {
  if (!is_ovf(path)) return read_spins(path, shape, box);
  require_nodes(read_ovf_mesh(path), path, shape);
  return numbers_in(box, shape, 3, read_ovf(path).values);
}

}  // namespace cayspin::inline v0_1::io::detail
