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

namespace cayspin::io {
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
std::uint32_t checksum_of(Sample const& sample, std::vector<double> const& spins, bool single) {
  auto const sum = [&](auto const& stored) {
    auto const bytes = std::as_bytes(std::span(stored));
    return spins_checksum(sample, fletcher32(bytes.data(), bytes.size()));
  };
  return single ? sum(std::vector<float>(spins.begin(), spins.end())) : sum(spins);
}

}  // namespace

StoredSpins::StoredSpins(std::filesystem::path const& path,
                         std::array<std::int64_t, 3> const& shape)
    : path_(path), dataset_(path, "/spins"), frame_{3} {
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

std::vector<double> StoredSpins::last() const { return checked(begin_); }

std::vector<double> StoredSpins::checked(Extents const& begin) const {
  QuietErrors const quiet;
  auto spins = dataset_.read(begin, frame_);
  if (!series_ || !series_->has_checksums()) return spins;
  auto const frame = static_cast<std::int64_t>(begin[0]);
  auto const sample = series_->read(frame, frame + 1, path_).at(0);
  bool const single =
      dataset_.epsilon() == static_cast<double>(std::numeric_limits<float>::epsilon());
  if (series_->spins_checksum(frame, path_) != checksum_of(sample, spins, single))
    dataset_.refuse(fmt::format("frame {} is damaged: its checksum differs", frame));
  return spins;
}

std::vector<double> StoredSpins::frame(std::int64_t frame) const {
  if (frame_.size() != 5) dataset_.refuse("it has no frames");
  auto begin = begin_;
  if (frame < 0 || static_cast<hsize_t>(frame) > begin[0])
    dataset_.refuse(fmt::format("it has no frame {}; accepted: 0 to {}", frame, begin[0]));
  begin[0] = static_cast<hsize_t>(frame);
  return checked(begin);
}

std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape) {
  return read_guarded(path, [&] { return StoredSpins(path, shape).last(); });
}

std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, std::int64_t frame) {
  return read_guarded(path, [&] { return StoredSpins(path, shape).frame(frame); });
}

}  // namespace cayspin::io
