// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "checksum.hpp"
#include "format.hpp"
#include "frame_writer.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/synced_file.hpp"
#include "io/trajectory.hpp"
#include "new_file.hpp"
#include "open_file_space.hpp"
#include "positions.hpp"
#include "require.hpp"
#include "scalar_series.hpp"

#include <bit>
#include <chrono>
#include <cstring>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto longest_wait = std::chrono::seconds(1);

// Returns the most bytes that a frame, or all pending samples, can take in addition to the spins:
// index nodes, and a new chunk in each of the scalar datasets.
std::uint64_t overhead_of(MoreScalars const& more) {
  constexpr std::uint64_t bytes = 512 * 1024, chunks_and_nodes = 4;
  return bytes + chunks_and_nodes * most_pending * sizeof(double) * more.count();
}

void write_units(RootAttributes const& attributes, Units const& units) {
  attributes.create("units", std::string(units.si ? si_units : reduced_units));
  if (!units.si) return;
  for (auto const& [name, member] : unit_attributes) attributes.create(name, units.*member);
}

void write_stage(RootAttributes const& attributes, StageBegin const& begin) {
  attributes.create("stage", begin.stage);
  attributes.create("stage_step", begin.step);
  attributes.create("stage_time", begin.time);
}

void write_attributes(hid_t file, TrajectoryHeader const& header,
                      std::filesystem::path const& path) {
  RootAttributes const attributes(file, path);
  attributes.create("format", std::int64_t{format_version});
  attributes.create("scene", header.scene_text);
  if (!header.resolved_scene.empty()) attributes.create("resolved_scene", header.resolved_scene);
  attributes.create("cayspin_version", header.cayspin_version);
  attributes.create("git_commit", header.git_commit);
  attributes.create("kokkos_version", header.kokkos_version);
  attributes.create("space", header.space);
  attributes.create("threads", std::int64_t{header.threads});
  attributes.create("precision", header.precision);
  write_units(attributes, header.units);
  if (header.stage) write_stage(attributes, *header.stage);
  attributes.create("text_checksum", std::bit_cast<std::int64_t>(text_checksum(header)));
  attributes.create("evaluations", std::int64_t{0});
  if (header.relaxes) {
    attributes.create("torque", 0.0);
    attributes.create("converged", std::int64_t{0});
  }
  attributes.create("wall_seconds", 0.0);
  attributes.create("step_seconds", 0.0);
  attributes.create("complete", std::int64_t{0});
}

void require_valid(TrajectoryHeader const& header, TrajectoryStorage const& storage,
                   std::vector<double> const& positions) {
  require_precision(header.precision);
  require_shape(header.shape);
  if (header.cell_sites < 1 || header.shape[2] % header.cell_sites != 0)
    throw std::invalid_argument("the planes of the lattice are not those of whole cells");
  if (storage.compression < 0 || storage.compression > 9)
    throw std::invalid_argument("compression is not in 0 to 9");
  if (storage.chunk < 0) throw std::invalid_argument("chunk is negative");
  auto const [nx, ny, nz] = header.shape;
  if (!positions.empty() && std::ssize(positions) != 3 * nx * ny * nz)
    throw std::invalid_argument("the positions are not three numbers of each site");
}

}  // namespace

class TrajectoryFile::Implementation {
 public:
  Implementation(std::filesystem::path path, TrajectoryHeader const& header, bool overwrite,
                 TrajectoryStorage const& storage, std::vector<double> const& positions,
                 std::function<void()> const& before_named)
      : path_(std::move(path)),
        single_(header.precision == single_precision),
        more_(header.more),
        has_stages_(header.stage.has_value()),
        overhead_(overhead_of(header.more)) {
    require_valid(header, storage, positions);
    if (storage.sync) synced_ = std::make_unique<SyncedFile>();
    NewFile file(path_, overwrite, false, synced_.get());
    space_ = OpenFileSpace(file.get(), path_);
    space_.reserve(overhead_ + header.scene_text.size() + header.resolved_scene.size() +
                       sizeof(double) * positions.size(),
                   path_);
    write_attributes(file.get(), header, path_);
    if (synced_)
      RootAttributes(file.get(), path_)
          .create("journal", std::bit_cast<std::int64_t>(synced_->mark()));
    create_datasets(file.get(), header, storage);
    if (!positions.empty()) write_positions(file.get(), header, positions, path_);
    check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), path_, "cannot create the file");
    if (before_named) before_named();
    file_ = file.commit();
  }

  ~Implementation() {
    QuietErrors const quiet;
    release();
  }

  void write_frame(Sample const& sample, void const* spins, bool single) {
    if (single != single_)
      throw std::logic_error(path_.string() + ": the precision of the spins is not the file's");
    require_spins(spins);
    begin_frame();
    spins_.add(planes_, spins);
    end_frame(sample, {});
  }

  void write_planes(std::int64_t planes, std::byte* spins) {
    require_spins(spins);
    if (spins_.planes() == 0) begin_frame();
    spins_.add_in_room(planes, spins);
  }

  // Readers count a frame once its scalars are there, so the scalars reach the disk after the
  // spins, or in the same commit.
  void end_frame(Sample const& sample, FrameNumbers const& numbers) {
    require_open();
    if (!spins_.is_whole())
      throw std::logic_error(path_.string() + ": a frame ends before its last plane");
    if (!synced_) flush();
    std::vector<double> more;
    for (auto const& mean : spins_.sublattices()) more.insert(more.end(), mean.begin(), mean.end());
    if (more_.shift) more.push_back(static_cast<double>(numbers.shift));
    if (has_stages_) more.push_back(static_cast<double>(numbers.stage));
    frame_series_.append({sample}, path_, spins_checksum(sample, spins_.checksum().value()), more);
    flush();
    spins_.begin(++frames_);
  }

  void write_scalars(Sample const& sample, std::vector<double> const& more) {
    require_open();
    if (more.size() != more_.count())
      throw std::logic_error(path_.string() + ": a sample with other numbers than the file's");
    pending_.push_back(sample);
    pending_more_.insert(pending_more_.end(), more.begin(), more.end());
    if (pending_.size() < most_pending && Clock::now() - flushed_ < longest_wait) return;
    space_.reserve(overhead_, path_);
    write_pending();
    flush();
  }

  void end(RunCost const& cost, bool complete) {
    require_open();
    if (!pending_.empty()) space_.reserve(overhead_, path_);
    write_pending();
    RootAttributes const attributes(file_.get(), path_);
    attributes.replace("evaluations", cost.evaluations);
    attributes.replace("wall_seconds", cost.wall_seconds);
    attributes.replace("step_seconds", cost.step_seconds);
    if (cost.relaxed) {
      attributes.replace("torque", cost.relaxed->torque);
      attributes.replace("converged", std::int64_t{cost.relaxed->converged});
    }
    flush();
    if (complete) {
      attributes.replace("complete", std::int64_t{1});
      flush();
    }
    check(release(), path_, "cannot close the file");
  }

  std::int64_t frames() const { return frames_; }
  std::filesystem::path const& path() const { return path_; }

 private:
  void create_datasets(hid_t file, TrajectoryHeader const& header,
                       TrajectoryStorage const& storage) {
    spins_ = FrameWriter(file, header, storage, path_);
    planes_ = header.shape[2];
    frame_series_ =
        ScalarSeries::create(file, path_, header.cell_sites,
                             {.shift = header.more.shift, .stage = header.stage.has_value()});
    scalars_ = create_group(file, "scalars", path_);
    sample_series_ = ScalarSeries::create(scalars_.get(), path_, 1, header.more);
  }

  void begin_frame() {
    require_open();
    spins_.begin(frames_);
    space_.reserve(spins_.frame_bytes() + overhead_, path_);
    write_pending();
  }

  void require_open() const {
    if (file_.get() < 0) throw std::logic_error(path_.string() + ": the trajectory has ended");
  }

  void require_spins(void const* spins) const {
    if (!spins) throw std::invalid_argument(path_.string() + ": the spins are a null pointer");
  }

  void write_pending() {
    sample_series_.append(pending_, path_, 1, pending_more_);
    pending_.clear();
    pending_more_.clear();
  }

  void flush() {
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), path_, "cannot write the file");
    if (int const error = synced_ ? synced_->commit() : 0)
      throw_failure(path_, "cannot write the file", std::strerror(error));
    flushed_ = Clock::now();
  }

  herr_t release() {
    if (file_.get() >= 0) space_.trim();
    spins_.close();
    frame_series_ = {};
    sample_series_ = {};
    scalars_.close();
    return file_.close();
  }

  std::filesystem::path path_;
  bool single_;
  MoreScalars more_;
  bool has_stages_;
  std::uint64_t overhead_;
  std::unique_ptr<SyncedFile> synced_;  // if set, HDF5 writes through it
  FileHandle file_;
  FrameWriter spins_;
  std::int64_t planes_ = 0;  // of a frame
  GroupHandle scalars_;
  ScalarSeries frame_series_, sample_series_;
  OpenFileSpace space_;
  std::vector<Sample> pending_;
  std::vector<double> pending_more_;
  Clock::time_point flushed_ = Clock::now();
  std::int64_t frames_ = 0;
};

TrajectoryFile::TrajectoryFile(std::filesystem::path path, TrajectoryHeader const& header,
                               bool overwrite, TrajectoryStorage const& storage,
                               std::vector<double> const& positions,
                               std::function<void()> const& before_named) {
  QuietErrors const quiet;
  implementation_ = std::make_unique<Implementation>(std::move(path), header, overwrite, storage,
                                                     positions, before_named);
}

TrajectoryFile::~TrajectoryFile() = default;
TrajectoryFile::TrajectoryFile(TrajectoryFile&&) noexcept = default;
TrajectoryFile& TrajectoryFile::operator=(TrajectoryFile&&) noexcept = default;

void TrajectoryFile::write_frame(std::int64_t step, double time, Scalars const& scalars,
                                 float const* spins) {
  QuietErrors const quiet;
  not_moved(implementation_).write_frame({step, time, scalars}, spins, true);
}

void TrajectoryFile::write_frame(std::int64_t step, double time, Scalars const& scalars,
                                 double const* spins) {
  QuietErrors const quiet;
  not_moved(implementation_).write_frame({step, time, scalars}, spins, false);
}

void TrajectoryFile::write_planes(std::int64_t planes, std::byte* spins) {
  QuietErrors const quiet;
  not_moved(implementation_).write_planes(planes, spins);
}

void TrajectoryFile::end_frame(std::int64_t step, double time, Scalars const& scalars,
                               FrameNumbers const& numbers) {
  QuietErrors const quiet;
  not_moved(implementation_).end_frame({step, time, scalars}, numbers);
}

void TrajectoryFile::write_scalars(std::int64_t step, double time, Scalars const& scalars,
                                   std::vector<double> const& more) {
  QuietErrors const quiet;
  not_moved(implementation_).write_scalars({step, time, scalars}, more);
}

void TrajectoryFile::finish(RunCost const& cost) {
  QuietErrors const quiet;
  not_moved(implementation_).end(cost, true);
}

void TrajectoryFile::close(RunCost const& cost) {
  QuietErrors const quiet;
  not_moved(implementation_).end(cost, false);
}

std::int64_t TrajectoryFile::frames() const { return not_moved(implementation_).frames(); }
std::filesystem::path const& TrajectoryFile::path() const {
  return not_moved(implementation_).path();
}

}  // namespace cayspin::inline v0_2::io
