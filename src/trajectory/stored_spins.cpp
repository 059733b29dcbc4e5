// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "stored_spins.hpp"

#include "checksum.hpp"
#include "fletcher32.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/error.hpp"
#include "hdf5/survives.hpp"

#include <cayspin/io/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <span>

namespace cayspin::inline v0_1::io {
namespace {

// Only trajectory files say with which cayspin they were written.
std::optional<ScalarSeries> open_series(hid_t file, std::filesystem::path const& path) {
  QuietErrors const quiet;
  auto const marked = H5Aexists(file, "cayspin_version");
  if (check(marked, path, "cannot read the attributes") == 0) return std::nullopt;
  return ScalarSeries::open(file, path);
}

// A killed run may leave the spins of a frame without its observables.
hsize_t whole_frames(RealDataset const& spins, std::optional<ScalarSeries> const& series,
                     std::filesystem::path const& path) {
  QuietErrors const quiet;
  auto const stored = spins.extents()[0];
  if (!series) return stored;
  bool const complete = RootAttributes(spins.file(), path).read_integer("complete") == 1;
  return std::min(stored, static_cast<hsize_t>(series->readable(complete ? 0 : 1, path)));
}

// As they stand in the file: what was a float is one again.
void add(Fletcher32& sum, std::vector<double> const& spins, bool single) {
  auto const add_bytes = [&](auto const& stored) {
    auto const bytes = std::as_bytes(std::span(stored));
    sum.add(bytes.data(), bytes.size());
  };
  single ? add_bytes(std::vector<float>(spins.begin(), spins.end())) : add_bytes(spins);
}

}  // namespace

StoredSpins::StoredSpins(std::filesystem::path const& path,
                         std::array<std::int64_t, 3> const& shape)
    : path_(path), shape_(shape), dataset_(path, "/spins"), frame_{3} {
  for (auto const extent : shape) frame_.insert(frame_.begin(), static_cast<hsize_t>(extent));
  auto const& extents = dataset_.extents();
  bool const framed = extents.size() == 5;
  if ((!framed && extents.size() != 4) ||
      !std::equal(frame_.begin(), frame_.end(), extents.end() - 4)) {
    auto const inner = fmt::format("{}, {}, {}, 3)", shape[2], shape[1], shape[0]);
    dataset_.refuse_extents(fmt::format("({} or (frame, {}", inner, inner));
  }
  begin_.assign(extents.size(), 0);
  if (!framed) return;
  series_ = open_series(dataset_.file(), path_);
  auto const frames = whole_frames(dataset_, series_, path_);
  if (frames == 0) dataset_.refuse("it holds no frame");
  begin_[0] = frames - 1;
  frame_.insert(frame_.begin(), 1);
}

std::vector<double> StoredSpins::last() const { return last(all()); }
std::vector<double> StoredSpins::last(SiteBox const& box) const { return checked(begin_, box); }

std::vector<double> StoredSpins::checked(Extents const& begin, SiteBox const& box) const {
  QuietErrors const quiet;
  auto const axis = frame_.size() - 4;  // z
  // HDF5 has a chunk whole in memory for any part of it.
  auto const of_chunk = static_cast<std::int64_t>(dataset_.chunk()[axis]);
  auto const at_once =
      std::max(of_chunk, planes_to_read(shape_, 3 * sizeof(double)) / of_chunk * of_chunk);
  bool const single =
      dataset_.epsilon() == static_cast<double>(std::numeric_limits<float>::epsilon());
  Fletcher32 sum;
  auto spins =
      read_by_planes(box, shape_, 3, at_once, [&](std::int64_t first, std::int64_t planes) {
        auto from = begin, extents = frame_;
        from[axis] = static_cast<hsize_t>(first);
        extents[axis] = static_cast<hsize_t>(planes);
        auto numbers = dataset_.read(from, extents);
        if (series_) add(sum, numbers, single);
        return numbers;
      });
  if (!series_ || !series_->has_checksums()) return spins;
  auto const frame = static_cast<std::int64_t>(begin[0]);
  auto const sample = series_->read(frame, frame + 1, path_).at(0);
  if (series_->spins_checksum(frame, path_) != spins_checksum(sample, sum.value()))
    dataset_.refuse(fmt::format("frame {} is damaged: its checksum differs", frame));
  return spins;
}

std::vector<double> StoredSpins::frame(std::int64_t frame) const {
  if (frame_.size() != 5) dataset_.refuse("it has no frames");
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
                               std::array<std::int64_t, 3> const& shape, SiteBox const& box) {
  return read_guarded(path, [&] { return StoredSpins(path, shape).last(box); });
}

std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, std::int64_t frame) {
  return read_guarded(path, [&] { return StoredSpins(path, shape).frame(frame); });
}

}  // namespace cayspin::inline v0_1::io
