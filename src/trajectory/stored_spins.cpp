// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "stored_spins.hpp"

#include "hdf5/error.hpp"

#include <cayspin/io/trajectory.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace cayspin::io {
namespace {

// A killed run may leave the spins of a frame without its observables. Only trajectory files say
// with which cayspin they were written.
hsize_t whole_frames(RealDataset const& spins, std::filesystem::path const& path) {
  QuietErrors const quiet;
  auto const stored = spins.extents()[0];
  auto const* const mark = "cayspin_version";
  if (check(H5Aexists(spins.file(), mark), path, "cannot read the attributes") == 0) return stored;
  auto const means = open_dataset(spins.file(), "magnetization", 2, path);
  return std::min(stored, dataset_extents(means.get(), path)[0]);
}

}  // namespace

StoredSpins::StoredSpins(std::filesystem::path const& path,
                         std::array<std::int64_t, 3> const& shape)
    : dataset_(path, "/spins"), frame_{3} {
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
  auto const frames = whole_frames(dataset_, path);
  if (frames == 0) dataset_.refuse("it holds no frame");
  begin_[0] = frames - 1;
  frame_.insert(frame_.begin(), 1);
}

std::vector<double> StoredSpins::last() const { return dataset_.read(begin_, frame_); }

std::vector<double> StoredSpins::frame(std::int64_t frame) const {
  if (frame_.size() != 5) dataset_.refuse("it has no frames");
  auto begin = begin_;
  if (frame < 0 || static_cast<hsize_t>(frame) > begin[0])
    dataset_.refuse(fmt::format("it has no frame {}; accepted: 0 to {}", frame, begin[0]));
  begin[0] = static_cast<hsize_t>(frame);
  return dataset_.read(begin, frame_);
}

std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape) {
  return StoredSpins(path, shape).last();
}

std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, std::int64_t frame) {
  return StoredSpins(path, shape).frame(frame);
}

}  // namespace cayspin::io
