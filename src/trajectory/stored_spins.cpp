// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "stored_spins.hpp"

#include "checksum.hpp"
#include "fletcher32.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

namespace cayspin::inline v0_2::io {
namespace {

// Returns the observables of the frames; nothing if the file is not a trajectory. No other file
// with frames has the attribute `cayspin_version`.
std::optional<ScalarSeries> open_series(hid_t file, std::int64_t cell_sites,
                                        std::filesystem::path const& path) {
  QuietErrors const quiet;
  auto const marked = H5Aexists(file, "cayspin_version");
  if (check(marked, path, "cannot read the attributes") == 0) return std::nullopt;
  return ScalarSeries::open(file, path, cell_sites);
}

// Returns the number of frames that have spins and observables. A killed run may leave the spins of
// a frame without its observables.
hsize_t whole_frames(RealDataset const& spins, std::optional<ScalarSeries> const& series,
                     std::filesystem::path const& path) {
  QuietErrors const quiet;
  auto const stored = spins.extents()[0];
  if (!series) return stored;
  bool const complete = RootAttributes(spins.file(), path).read_integer("complete") == 1;
  return std::min(stored, static_cast<hsize_t>(series->readable(complete ? 0 : 1, path)));
}

// Adds the spins in their stored type, because floats were read as double.
void add(Fletcher32& sum, std::vector<double> const& spins, bool single) {
  auto const add_bytes = [&](auto const& stored) { sum.add(std::as_bytes(std::span(stored))); };
  single ? add_bytes(std::vector<float>(spins.begin(), spins.end())) : add_bytes(spins);
}

// Returns the part of a box that has site number `site` of the cells. Its planes count only such
// sites: plane k is plane k * sites + site of the lattice.
SiteBox of_site(SiteBox box, std::int64_t site, std::int64_t sites) {
  auto const planes_before = [&](std::int64_t plane) { return (plane + sites - 1 - site) / sites; };
  auto const end = planes_before(box.begin[2] + box.extent[2]);
  box.begin[2] = planes_before(box.begin[2]);
  box.extent[2] = end - box.begin[2];
  return box;
}

}  // namespace

StoredSpins::StoredSpins(std::filesystem::path const& path,
                         std::array<std::int64_t, 3> const& shape, std::int64_t cell_sites)
    : path_(path), shape_(shape), dataset_(path, "/spins") {
  auto const& extents = dataset_.extents();
  auto const rank = extents.size();
  if (rank < 4 || rank > 6) refuse_extents(cell_sites);
  auto const [nx, ny, nz] = shape;
  Extents const inner{static_cast<hsize_t>(ny), static_cast<hsize_t>(nx), 3};
  if (!std::equal(inner.begin(), inner.end(), extents.end() - 3)) refuse_extents(cell_sites);
  auto const planes = static_cast<std::int64_t>(extents[rank - 4]);
  bool const by_sites = rank == 6;
  if (by_sites) sites_ = static_cast<std::int64_t>(extents[1]);
  bool const fits = sites_ >= 1 && nz % sites_ == 0 && planes == nz / sites_;
  if (!fits || (by_sites && cell_sites != any_cell_sites && sites_ != cell_sites))
    refuse_extents(cell_sites);
  framed_ = rank > 4;
  begin_.assign(rank, 0);
  frame_ = extents;
  if (by_sites) frame_[1] = 1;
  if (!framed_) return;
  frame_[0] = 1;
  series_ = open_series(dataset_.file(), sites_, path_);
  auto const frames = whole_frames(dataset_, series_, path_);
  if (frames == 0) dataset_.refuse("it holds no frame");
  begin_[0] = frames - 1;
}

void StoredSpins::refuse_extents(std::int64_t cell_sites) const {
  auto const [nx, ny, nz] = shape_;
  auto const inner = fmt::format("{}, {}, {}, 3)", nz, ny, nx);
  auto accepted = fmt::format("({} or (frame, {}", inner, inner);
  if (cell_sites > 1)
    accepted += fmt::format(" or (frame, {}, {}, {}, {}, 3)", cell_sites, nz / cell_sites, ny, nx);
  dataset_.refuse_extents(accepted);
}

std::vector<double> StoredSpins::last() const { return last(all()); }
std::vector<double> StoredSpins::last(SiteBox const& box) const { return checked(begin_, box); }

// Plane k * sites + s holds site s of the cells with number k along z.
template <class Read>
std::vector<double> StoredSpins::by_planes(SiteBox const& box, Read const& read) const {
  auto const [nx, ny, nz] = box.extent;
  auto const of_plane = 3 * nx * ny;
  std::vector<double> spins(static_cast<std::size_t>(of_plane * nz));
  for (std::int64_t site = 0; site < sites_; ++site) {
    auto const numbers = read(site);
    auto const part = of_site(box, site, sites_);
    for (std::int64_t k = 0; k < part.extent[2]; ++k)
      std::copy_n(numbers.begin() + k * of_plane, of_plane,
                  spins.begin() + ((part.begin[2] + k) * sites_ + site - box.begin[2]) * of_plane);
  }
  return spins;
}

std::vector<double> StoredSpins::checked(Extents const& begin, SiteBox const& box) const {
  QuietErrors const quiet;
  auto const axis = frame_.size() - 4;  // z
  // HDF5 reads a whole chunk into memory for any part of it.
  auto const of_chunk = static_cast<std::int64_t>(dataset_.chunk()[axis]);
  auto const at_once =
      std::max(of_chunk, planes_to_read(shape_, 3 * sizeof(double)) / of_chunk * of_chunk);
  bool const single =
      dataset_.epsilon() == static_cast<double>(std::numeric_limits<float>::epsilon());
  Fletcher32 sum;
  auto block = shape_;
  block[2] /= sites_;
  auto const read = [&](std::int64_t site) {
    return read_by_planes(of_site(box, site, sites_), block, 3, at_once,
                          [&](std::int64_t first, std::int64_t planes) {
                            auto from = begin, extents = frame_;
                            from[axis] = static_cast<hsize_t>(first);
                            extents[axis] = static_cast<hsize_t>(planes);
                            if (sites_ > 1) from[axis - 1] = static_cast<hsize_t>(site);
                            auto numbers = dataset_.read(from, extents);
                            if (series_) add(sum, numbers, single);
                            return numbers;
                          });
  };
  std::vector<double> spins;
  if (sites_ == 1)
    spins = read(0);
  else
    spins = by_planes(box, read);
  if (!series_ || !series_->has_checksums()) return spins;
  auto const frame = static_cast<std::int64_t>(begin[0]);
  auto const sample = series_->read(frame, frame + 1, path_).at(0);
  if (series_->spins_checksum(frame, path_) != spins_checksum(sample, sum.value()))
    dataset_.refuse(fmt::format("frame {} is damaged: its checksum differs", frame));
  return spins;
}

std::vector<double> StoredSpins::frame(std::int64_t frame) const {
  if (!framed_) dataset_.refuse("it has no frames");
  auto begin = begin_;
  if (frame < 0 || static_cast<hsize_t>(frame) > begin[0])
    dataset_.refuse(fmt::format("it has no frame {}; accepted: 0 to {}", frame, begin[0]));
  begin[0] = static_cast<hsize_t>(frame);
  return checked(begin, all());
}

std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape) {
  return read_guarded(path, [&] { return StoredSpins(path, shape).last(); });
}

std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, SiteBox const& box,
                               std::int64_t cell_sites) {
  return read_guarded(path, [&] { return StoredSpins(path, shape, cell_sites).last(box); });
}

std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, std::int64_t frame,
                               std::int64_t cell_sites) {
  return read_guarded(path, [&] { return StoredSpins(path, shape, cell_sites).frame(frame); });
}

}  // namespace cayspin::inline v0_2::io
