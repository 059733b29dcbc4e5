// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "start_file.hpp"

#include "hdf5/attribute.hpp"
#include "hdf5/error.hpp"
#include "hdf5/real_dataset.hpp"
#include "hdf5/survives.hpp"
#include "trajectory/scalar_series.hpp"
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

/// /spins (site, nz, ny, nx, 3) of a crystal, or the last whole frame of (frame, site, ..).
class SpinsOfCrystal {
 public:
  SpinsOfCrystal(std::filesystem::path const& path, Lattice const& lattice)
      : shape_(lattice.shape),
        sites_(static_cast<std::int64_t>(lattice.basis.size())),
        dataset_(path, "/spins") {
    auto const& extents = dataset_.extents();
    std::array<std::int64_t, 5> const expected{sites_, shape_[2] / sites_, shape_[1], shape_[0], 3};
    auto const same = [](std::int64_t a, hsize_t b) { return static_cast<hsize_t>(a) == b; };
    bool const framed = extents.size() == 6;
    if ((!framed && extents.size() != 5) ||
        !std::equal(expected.begin(), expected.end(), extents.end() - 5, same)) {
      auto const inner = fmt::format("{})", fmt::join(expected, ", "));
      dataset_.refuse_extents(fmt::format("({} or (frame, {}", inner, inner));
    }
    if (!framed) return;
    auto const frames = whole_frames(path);
    if (frames == 0) dataset_.refuse("it holds no frame");
    frame_ = frames - 1;
  }

  /// In the order of a lattice, whose planes are the sites of a cell in turn.
  std::vector<double> in(SiteBox const& box) const {
    auto const plane = 3 * box.extent[0] * box.extent[1];
    auto const end = box.begin[2] + box.extent[2];
    std::vector<double> spins(static_cast<std::size_t>(plane * box.extent[2]));
    // HDF5 has a chunk whole in memory for any part of it.
    auto const of_chunk = static_cast<std::int64_t>(dataset_.chunk().rbegin()[3]);
    auto const at_once = std::max(of_chunk, planes_to_read(shape_, 3 * sizeof(double)));
    for (std::int64_t site = 0; site < sites_; ++site) {
      // Of these cells the sites are in the box.
      auto const first = std::max<std::int64_t>(0, box.begin[2] - site + sites_ - 1) / sites_;
      auto const last = std::max<std::int64_t>(0, end - site + sites_ - 1) / sites_;
      for (auto k = first; k < last; k += at_once) {
        auto const cells = std::min(at_once, last - k);
        auto const numbers =
            dataset_.read(extents({site, k, box.begin[1], box.begin[0], 0}, frame_),
                          extents({1, cells, box.extent[1], box.extent[0], 3}, 1));
        for (std::int64_t cell = 0; cell < cells; ++cell)
          std::copy_n(numbers.begin() + cell * plane, plane,
                      spins.begin() + ((k + cell) * sites_ + site - box.begin[2]) * plane);
      }
    }
    return spins;
  }

 private:
  Extents extents(std::array<std::int64_t, 5> const& inner, hsize_t frame) const {
    Extents all(inner.begin(), inner.end());
    if (dataset_.extents().size() == 6) all.insert(all.begin(), frame);
    return all;
  }

  // A killed run may leave the spins of a frame without its observables.
  hsize_t whole_frames(std::filesystem::path const& path) const {
    auto const stored = dataset_.extents()[0];
    RootAttributes const attributes(dataset_.file(), path);
    if (!attributes.has("cayspin_version")) return stored;
    auto const series = ScalarSeries::open(dataset_.file(), path);
    auto const torn = attributes.read_integer("complete") == 1 ? 0 : 1;
    return std::min(stored, static_cast<hsize_t>(series.readable(torn, path)));
  }

  std::array<std::int64_t, 3> shape_;
  std::int64_t sites_;
  RealDataset dataset_;
  hsize_t frame_ = 0;
};

}  // namespace

void check_start_file(std::filesystem::path const& path, Lattice const& lattice) {
  if (is_ovf(path)) {
    refuse_crystals(lattice, path);
    require_nodes(read_ovf_mesh(path), path, lattice.shape);
  } else if (lattice.basis.size() > 1) {
    try_in_child(path, [&] { SpinsOfCrystal(path, lattice); });
  } else {
    try_in_child(path, [&] { StoredSpins(path, lattice.shape, 1); });
  }
}

std::vector<double> read_start_file(std::filesystem::path const& path, Lattice const& lattice,
                                    SiteBox const& box) {
  if (!is_ovf(path)) {
    if (lattice.basis.size() == 1) return read_spins(path, lattice.shape, box, 1);
    return read_guarded(path, [&] { return SpinsOfCrystal(path, lattice).in(box); });
  }
  refuse_crystals(lattice, path);
  require_nodes(read_ovf_mesh(path), path, lattice.shape);
  return numbers_in(box, lattice.shape, 3, read_ovf(path).values);
}

}  // namespace cayspin::inline v0_1::io::detail
