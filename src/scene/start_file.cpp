// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "start_file.hpp"

#include "hdf5/read_in_child.hpp"
#include "hdf5/real_dataset.hpp"
#include "trajectory/stored_spins.hpp"

#include <cayspin/io/ovf.hpp>
#include <cayspin/io/trajectory.hpp>

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
class StateOfCrystal {
 public:
  StateOfCrystal(std::filesystem::path const& path, Lattice const& lattice)
      : shape_(lattice.shape), sites_(sites_of(lattice)), dataset_(path, "/spins") {
    std::array<std::int64_t, 5> const expected{sites_, shape_[2] / sites_, shape_[1], shape_[0], 3};
    auto const& extents = dataset_.extents();
    auto const same = [](std::int64_t a, hsize_t b) { return static_cast<hsize_t>(a) == b; };
    if (!std::equal(expected.begin(), expected.end(), extents.begin(), extents.end(), same)) {
      auto const inner = fmt::format("{})", fmt::join(expected, ", "));
      dataset_.refuse_extents(fmt::format("({} or (frame, {}", inner, inner));
    }
  }

  /// In the order of a lattice, whose planes are the sites of a cell in turn.
  std::vector<double> in(SiteBox const& box) const {
    auto const plane = 3 * box.extent[0] * box.extent[1];
    std::vector<double> spins;
    for (std::int64_t z = box.begin[2]; z < box.begin[2] + box.extent[2]; ++z) {
      auto const numbers =
          dataset_.read(extents({z % sites_, z / sites_, box.begin[1], box.begin[0], 0}),
                        extents({1, 1, box.extent[1], box.extent[0], 3}));
      spins.insert(spins.end(), numbers.begin(), numbers.begin() + plane);
    }
    return spins;
  }

 private:
  static Extents extents(std::array<std::int64_t, 5> const& inner) {
    return Extents(inner.begin(), inner.end());
  }

  std::array<std::int64_t, 3> shape_;
  std::int64_t sites_;
  RealDataset dataset_;
};

bool is_state_of_crystal(std::filesystem::path const& path, Lattice const& lattice) {
  return lattice.basis.size() > 1 && RealDataset(path, "/spins").extents().size() != 6;
}

}  // namespace

void check_start_file(std::filesystem::path const& path, Lattice const& lattice) {
  if (is_ovf(path)) {
    refuse_crystals(lattice, path);
    require_nodes(read_ovf_mesh(path), path, lattice.shape);
  } else {
    try_in_child(path, [&] {
      if (is_state_of_crystal(path, lattice))
        StateOfCrystal(path, lattice);
      else
        StoredSpins(path, lattice.shape, sites_of(lattice));
    });
  }
}

std::vector<double> read_start_file(std::filesystem::path const& path, Lattice const& lattice,
                                    SiteBox const& box) {
  if (!is_ovf(path)) {
    if (read_guarded(path, [&] { return is_state_of_crystal(path, lattice); }))
      return read_guarded(path, [&] { return StateOfCrystal(path, lattice).in(box); });
    return read_spins(path, lattice.shape, box, sites_of(lattice));
  }
  refuse_crystals(lattice, path);
  require_nodes(read_ovf_mesh(path), path, lattice.shape);
  return numbers_in(box, lattice.shape, 3, read_ovf(path).values);
}

}  // namespace cayspin::inline v0_1::io::detail
