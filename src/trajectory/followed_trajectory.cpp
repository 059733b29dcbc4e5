// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "scalar_series.hpp"
#include "trajectory_reader.hpp"

#include <cayspin/io/follow.hpp>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <string_view>

namespace cayspin::io {
namespace {

FollowedTrajectory::Clock::time_point as_time(std::int64_t seconds, std::uint32_t nanoseconds) {
  auto const since = std::chrono::seconds(seconds) + std::chrono::nanoseconds(nanoseconds);
  return FollowedTrajectory::Clock::time_point(
      std::chrono::duration_cast<FollowedTrajectory::Clock::duration>(since));
}

}  // namespace

void FollowedTrajectory::clear() {
  steps_.clear();
  times_.clear();
  scalars_.clear();
  seen_ = 0;
}

void FollowedTrajectory::read_times_of_file() {
  struct statx status {};
  if (::statx(AT_FDCWD, path_.c_str(), 0, STATX_MTIME | STATX_BTIME | STATX_INO, &status) != 0)
    throw_failure(path_, "cannot open the file", std::strerror(errno));
  written_ = as_time(status.stx_mtime.tv_sec, status.stx_mtime.tv_nsec);
  created_.reset();
  if ((status.stx_mask & STATX_BTIME) != 0)
    created_ = as_time(status.stx_btime.tv_sec, status.stx_btime.tv_nsec);
  if (identity_ != status.stx_ino) clear();
  identity_ = status.stx_ino;
}

void FollowedTrajectory::look() {
  QuietErrors const quiet;
  read_times_of_file();
  auto const file = open_file(path_, Locking::off);
  // `complete` is written last: once it is there, so is all else.
  auto const info = read_header(file.get(), path_);
  auto series = ScalarSeries::open(file.get(), path_);
  GroupHandle const scalars(
      check(H5Gopen2(file.get(), "scalars", H5P_DEFAULT), path_, "cannot open group scalars"));
  auto samples = ScalarSeries::open(scalars.get(), path_);
  bool const of_frames = samples.size(path_) < series.size(path_);
  if (!of_frames) std::swap(series, samples);
  if (of_frames != of_frames_) clear();
  of_frames_ = of_frames;
  auto const in_file = series.size(path_);
  auto const begin = static_cast<std::int64_t>(steps_.size());
  if (in_file < begin) clear();
  auto const believed = info.complete ? in_file : std::min(seen_, in_file);
  auto const fresh = believed > begin ? series.read(begin, believed, path_) : std::vector<Sample>();
  for (auto const& sample : fresh) {
    steps_.push_back(sample.step);
    times_.push_back(sample.time);
    scalars_.push_back(sample.scalars);
  }
  seen_ = in_file;
  header_ = info.header;
  cost_ = info.cost;
  complete_ = info.complete;
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

}  // namespace cayspin::io
