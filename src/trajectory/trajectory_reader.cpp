// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "checksum.hpp"
#include "ensemble_format.hpp"
#include "files/journal.hpp"
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "hdf5/handle.hpp"
#include "io/trajectory.hpp"
#include "require.hpp"
#include "scalar_series.hpp"
#include "sweep_format.hpp"
#include "units_of_file.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <bit>
#include <cerrno>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {
namespace {

// Compares the texts with their checksum, because HDF5's own checksums do not cover them. Files of
// earlier versions have no such checksum.
void require_whole_texts(RootAttributes const& attributes, TrajectoryHeader const& header,
                         std::filesystem::path const& path) {
  if (!attributes.has("text_checksum")) return;
  auto const stored = std::bit_cast<std::uint64_t>(attributes.read_integer("text_checksum"));
  if (stored != text_checksum(header))
    throw_failure(path, "cannot read the trajectory",
                  "its attributes are damaged: their checksum differs");
}

// Reads the extents of /spins: (frame, nz, ny, nx, 3), or (frame, site, nz, ny, nx, 3) for a
// crystal.
void read_extents(hid_t file, TrajectoryInfo& info, std::filesystem::path const& path) {
  constexpr std::size_t rank = 5;
  auto const spins = open_dataset(file, "spins", path);
  auto extents = dataset_extents(spins.get(), path);
  info.frames = extents.empty() ? 0 : static_cast<std::int64_t>(extents[0]);
  auto& header = info.header;
  if (extents.size() == rank + 1) {
    header.cell_sites = static_cast<std::int64_t>(extents[1]);
    extents.erase(extents.begin() + 1);
  } else if (extents.size() != rank) {
    throw_failure(path, "cannot read dataset spins", "its rank is neither 5 nor 6");
  }
  for (int axis = 0; axis < 3; ++axis)
    header.shape[axis] = static_cast<std::int64_t>(extents[3 - axis]);
  require_lattice_of_file(header.shape, header.cell_sites, path);
  header.shape[2] *= header.cell_sites;
}

std::string_view kind_of_other(RootAttributes const& attributes) {
  struct Kind {
    char const* format;  // the attribute that only these files have
    std::string_view name;
  };
  for (auto const& [format, name] :
       {Kind{ensemble_format, "the file of an ensemble"}, Kind{sweep_format, "the file of a sweep"},
        Kind{"path_format", "the file of a path"},
        Kind{"cayspin_modes_format", "the file of modes"},
        Kind{"checkpoint_format", "a checkpoint"},
        Kind{"ensemble_checkpoint_format", "the checkpoint of an ensemble"}})
    if (attributes.has(format)) return name;
  return {};
}

// Reads the root attributes and the extents of /spins. In the result, `frames` is the number of
// frames in /spins.
TrajectoryInfo read_header(hid_t file, std::filesystem::path const& path) {
  RootAttributes const attributes(file, path);
  TrajectoryInfo info;
  info.path = path;
  if (auto const other = kind_of_other(attributes); !other.empty())
    throw std::runtime_error(path.string() + ": it is " + std::string(other) +
                             "; accepted: the trajectory file of a run or of relax");
  attributes.require_version("format", format_version, "cannot read the trajectory");
  info.format = format_version;
  info.header.scene_text = attributes.read_text("scene");
  if (attributes.has("resolved_scene"))
    info.header.resolved_scene = attributes.read_text("resolved_scene");
  info.header.cayspin_version = attributes.read_text("cayspin_version");
  info.header.git_commit = attributes.read_text("git_commit");
  info.header.kokkos_version = attributes.read_text("kokkos_version");
  info.header.space = attributes.read_text("space");
  info.header.threads = static_cast<int>(attributes.read_integer("threads"));
  info.header.precision = attributes.read_text("precision");
  info.header.units = read_units(attributes);
  require_whole_texts(attributes, info.header, path);
  if (attributes.has("stage"))
    info.header.stage = {attributes.read_integer("stage"), attributes.read_integer("stage_step"),
                         attributes.read_real("stage_time")};
  info.cost.evaluations = attributes.read_integer("evaluations");
  info.cost.wall_seconds = attributes.read_real("wall_seconds");
  info.cost.step_seconds = attributes.read_real("step_seconds");
  if (attributes.has("converged"))
    info.cost.relaxed = {attributes.read_real("torque"), attributes.read_integer("converged") == 1};
  info.complete = attributes.read_integer("complete") == 1;
  read_extents(file, info, path);
  return info;
}

TrajectoryInfo read_whole_info(std::filesystem::path const& path, Locking locking) {
  auto const file = open_file(path, locking);
  // `complete` is written last: once it is set, everything else is there.
  auto info = read_header(file.get(), path);
  auto const series = ScalarSeries::open(file.get(), path, info.header.cell_sites);
  auto const torn_frames = info.complete ? 0 : locking == Locking::on ? 1 : most_pending;
  info.frames = std::min(info.frames, series.readable(torn_frames, path));
  for (auto const& sample : series.read(0, info.frames, path)) {
    info.frame_steps.push_back(sample.step);
    info.frame_times.push_back(sample.time);
    info.frame_scalars.push_back(sample.scalars);
  }
  auto const more = series.read_more(0, info.frames, path);
  auto const sites = static_cast<std::size_t>(info.header.cell_sites);
  auto const stored = series.more_scalars(path);
  for (std::size_t frame = 0; frame < info.frame_steps.size(); ++frame) {
    auto const* const of_frame = more.data() + frame * series.more_count();
    for (std::size_t site = 0; sites > 1 && site < sites; ++site)
      info.frame_sublattices.push_back(
          {of_frame[3 * site], of_frame[3 * site + 1], of_frame[3 * site + 2]});
    auto const* last = of_frame + series.more_count();
    if (stored.stage) info.frame_stages.push_back(static_cast<std::int64_t>(*--last));
    if (stored.shift) info.frame_shifts.push_back(static_cast<std::int64_t>(*--last));
  }
  auto const group = open_group(file.get(), "scalars", path);
  auto const samples = ScalarSeries::open(group.get(), path);
  info.samples = samples.readable(info.complete ? 0 : most_pending, path);
  info.header.more = samples.more_scalars(path);
  if (info.samples > 0 && (!info.complete || samples.more_count() > 0)) {
    auto const last = info.samples - 1;
    info.last_sample = samples.read(last, info.samples, path).front();
    info.more_of_last_sample = samples.read_more(last, info.samples, path);
  }
  return info;
}

}  // namespace

void complete_file(std::filesystem::path const& path) { complete_from_journal(path); }

std::string kind_of_other_file(std::filesystem::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] {
    auto const file = open_file(path);
    return std::string(kind_of_other(RootAttributes(file.get(), path)));
  });
}

TrajectoryInfo read_info(std::filesystem::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] { return read_whole_info(path, Locking::on); });
}

TrajectoryInfo read_info_while_written(std::filesystem::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] { return read_whole_info(path, Locking::off); });
}

std::optional<bool> is_being_written(std::filesystem::path const& path) {
  char const* const locking = std::getenv("HDF5_USE_FILE_LOCKING");
  if (locking && (std::string_view(locking) == "FALSE" || std::string_view(locking) == "0"))
    return std::nullopt;
  int const file = ::open(path.c_str(), O_RDONLY | O_NONBLOCK | O_CLOEXEC);
  if (file < 0) return std::nullopt;
  bool const got = ::flock(file, LOCK_SH | LOCK_NB) == 0;
  int const error = errno;
  ::close(file);
  if (got) return false;
  return error == EWOULDBLOCK ? std::optional(true) : std::nullopt;
}

}  // namespace cayspin::inline v0_2::io
