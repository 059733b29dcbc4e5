// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "format.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/follow.hpp"
#include "scalar_series.hpp"
#include "trajectory_reader.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace cayspin::inline v0_1::io {
namespace {

FollowedTrajectory::Clock::time_point as_time(std::int64_t seconds, std::uint32_t nanoseconds) {
  auto const since = std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds);
  return FollowedTrajectory::Clock::time_point(
      std::chrono::duration_cast<FollowedTrajectory::Clock::duration>(since));
}

}  // namespace

void FollowedTrajectory::read_times_of_file() {
  struct statx status {};
  if (::statx(AT_FDCWD, path_.c_str(), 0, STATX_MTIME | STATX_BTIME | STATX_INO, &status) != 0)
    throw_failure(path_, "cannot open the file", std::strerror(errno));
  written_ = as_time(status.stx_mtime.tv_sec, status.stx_mtime.tv_nsec);
  auto const before = created_;
  created_.reset();
  if ((status.stx_mask & STATX_BTIME) != 0)
    created_ = as_time(status.stx_btime.tv_sec, status.stx_btime.tv_nsec);
  if (identity_ != status.stx_ino || created_ != before) samples_ = frames_ = {};
  identity_ = status.stx_ino;
}

void FollowedTrajectory::read_series(hid_t group, std::int64_t cell_sites, Series& series,
                                     bool all) const {
  auto const stored = ScalarSeries::open(group, path_, cell_sites);
  auto const in_file = stored.readable(all ? 0 : most_pending, path_);
  auto const begin = static_cast<std::int64_t>(series.steps.size());
  if (in_file < begin)
    throw_failure(path_, "cannot read the trajectory", "samples are missing that were there");
  auto const believed = all ? in_file : std::clamp(series.seen, begin, in_file);
  for (auto const& sample : stored.read(begin, believed, path_)) {
    series.steps.push_back(sample.step);
    series.times.push_back(sample.time);
    series.scalars.push_back(sample.scalars);
  }
  series.seen = in_file;
}

void FollowedTrajectory::read_file() {
  read_times_of_file();
  auto const file = open_file(path_, Locking::off);
  // `complete` is written last: once it is there, so is all else.
  auto const info = read_header(file.get(), path_);
  read_series(file.get(), info.header.cell_sites, frames_, info.complete);
  auto const scalars = open_group(file.get(), "scalars", path_);
  read_series(scalars.get(), 1, samples_, info.complete);
  header_ = info.header;
  cost_ = info.cost;
  complete_ = info.complete;
}

// A trial must not change what this object knows: it is that of another process, or none.
void FollowedTrajectory::look() {
  QuietErrors const quiet;
  try_before(path_, [&] { read_file(); });
  read_file();
}

std::optional<bool> is_being_written(std::filesystem::path const& path) {
  char const* const locking = std::getenv("HDF5_USE_FILE_LOCKING");
  if (locking && std::string_view(locking) == "FALSE") return std::nullopt;
  int const file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  bool const got = ::flock(file, LOCK_SH | LOCK_NB) == 0;
  int const error = errno;
  ::close(file);
  if (got) return false;
  return error == EWOULDBLOCK ? std::optional(true) : std::nullopt;
}

}  // namespace cayspin::inline v0_1::io
