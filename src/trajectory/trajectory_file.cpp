// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "checksum.hpp"
#include "fletcher32.hpp"
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "new_file.hpp"
#include "open_file_space.hpp"
#include "require.hpp"
#include "scalar_series.hpp"

#include <cayspin/io/trajectory.hpp>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstring>
#include <limits>
#include <span>
#include <stdexcept>
#include <utility>

namespace cayspin::io {
namespace {

using Clock = std::chrono::steady_clock;
constexpr auto longest_wait = std::chrono::seconds(1);

// What a frame, or as many samples as may be pending, can take besides the spins: index nodes and a
// new chunk in each of the ten scalar datasets.
constexpr std::uint64_t overhead_bytes = 512 * 1024;

void write_units(RootAttributes const& attributes, Units const& units) {
  attributes.create("units", std::string(units.si ? si_units : reduced_units));
  if (!units.si) return;
  for (auto const& [name, member] : unit_attributes) attributes.create(name, units.*member);
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
  attributes.create("text_checksum", std::bit_cast<std::int64_t>(text_checksum(header)));
  attributes.create("evaluations", std::int64_t{0});
  attributes.create("wall_seconds", 0.0);
  attributes.create("step_seconds", 0.0);
  attributes.create("complete", std::int64_t{0});
}

// A frame that never reached the disk reads as NaN, not as zeros.
DatasetHandle create_spins(hid_t file, TrajectoryHeader const& header,
                           TrajectoryStorage const& storage, std::filesystem::path const& path) {
  bool const single = header.precision == single_precision;
  auto const chunk =
      frame_chunk(header.shape, single ? sizeof(float) : sizeof(double), storage.chunk);
  std::array<hsize_t, 4> inner{0, 0, 0, 3};
  for (int axis = 0; axis < 3; ++axis) inner[2 - axis] = static_cast<hsize_t>(header.shape[axis]);
  PropertyHandle properties(H5Pcreate(H5P_DATASET_CREATE));
  auto const missing = std::numeric_limits<double>::quiet_NaN();
  check(H5Pset_fill_value(properties.get(), H5T_NATIVE_DOUBLE, &missing), path,
        "cannot create dataset spins");
  if (storage.compression > 0) {
    check(H5Pset_shuffle(properties.get()), path, "cannot create dataset spins");
    check(H5Pset_deflate(properties.get(), static_cast<unsigned>(storage.compression)), path,
          "cannot create dataset spins");
  }
  check(H5Pset_fletcher32(properties.get()), path, "cannot create dataset spins");
  return create_growing_dataset(file, "spins", single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE, chunk,
                                std::move(properties), path, inner);
}

void require_valid(TrajectoryHeader const& header, TrajectoryStorage const& storage) {
  require_precision(header.precision);
  require_shape(header.shape);
  if (storage.compression < 0 || storage.compression > 9)
    throw std::invalid_argument("compression is not in 0 to 9");
  if (storage.chunk < 0) throw std::invalid_argument("chunk is negative");
}

}  // namespace

class TrajectoryFile::Implementation {
 public:
  Implementation(std::filesystem::path path, TrajectoryHeader const& header, bool overwrite,
                 TrajectoryStorage const& storage)
      : path_(std::move(path)), single_(header.precision == single_precision) {
    require_valid(header, storage);
    NewFile file(path_, overwrite);
    space_ = OpenFileSpace(file.get(), path_);
    space_.reserve(overhead_bytes + header.scene_text.size() + header.resolved_scene.size(), path_);
    write_attributes(file.get(), header, path_);
    create_datasets(file.get(), header, storage);
    check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), path_, "cannot create the file");
    file_ = file.commit();
  }

  ~Implementation() {
    QuietErrors const quiet;
    release();
  }

  void write_frame(Sample const& sample, void const* spins, bool single) {
    if (single != single_)
      throw std::logic_error(path_.string() + ": spins given in another precision than the file's");
    require_spins(spins);
    write_whole(sample, [&] {
      append_block(spins_.get(), single ? H5T_NATIVE_FLOAT : H5T_NATIVE_DOUBLE,
                   {static_cast<hsize_t>(frames_), 0, 0, 0, 0}, frame_extents_, spins, path_);
      return fletcher32(static_cast<std::byte const*>(spins), frame_bytes_);
    });
  }

  // What the filter of HDF5 would do takes it two copies of the frame.
  void write_frame_with_room(Sample const& sample, std::byte* spins) {
    if (!raw_chunks_) return write_frame(sample, spins, single_);
    require_spins(spins);
    write_whole(sample, [&] {
      auto const checksum = fletcher32(spins, frame_bytes_);
      std::memcpy(spins + frame_bytes_, &checksum, checksum_bytes);
      append_raw_chunk(spins_.get(), {static_cast<hsize_t>(frames_), 0, 0, 0, 0}, frame_extents_,
                       spins, frame_bytes_ + checksum_bytes, path_);
      return checksum;
    });
  }

  // Readers count a frame once its scalars are there, so those reach the disk after its spins.
  // `write_spins` returns their sum.
  template <class WriteSpins>
  void write_whole(Sample const& sample, WriteSpins const& write_spins) {
    require_open();
    space_.reserve(frame_bytes_ + overhead_bytes, path_);
    write_pending();
    std::uint32_t const sum = write_spins();
    flush();
    frame_series_.append({sample}, path_, spins_checksum(sample, sum));
    flush();
    ++frames_;
  }

  void write_scalars(Sample const& sample) {
    require_open();
    pending_.push_back(sample);
    if (pending_.size() < most_pending && Clock::now() - flushed_ < longest_wait) return;
    space_.reserve(overhead_bytes, path_);
    write_pending();
    flush();
  }

  void end(RunCost const& cost, bool complete) {
    require_open();
    if (!pending_.empty()) space_.reserve(overhead_bytes, path_);
    write_pending();
    RootAttributes const attributes(file_.get(), path_);
    attributes.replace("evaluations", cost.evaluations);
    attributes.replace("wall_seconds", cost.wall_seconds);
    attributes.replace("step_seconds", cost.step_seconds);
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
    spins_ = create_spins(file, header, storage, path_);
    frame_extents_ = dataset_extents(spins_.get(), path_);
    frame_extents_[0] = 1;
    frame_bytes_ = single_ ? sizeof(float) : sizeof(double);
    for (auto const extent : frame_extents_) frame_bytes_ *= extent;
    auto const chunk =
        frame_chunk(header.shape, single_ ? sizeof(float) : sizeof(double), storage.chunk);
    raw_chunks_ = std::endian::native == std::endian::little && storage.compression == 0 &&
                  std::ranges::equal(chunk, frame_extents_);
    frame_series_ = ScalarSeries::create(file, path_);
    scalars_ = GroupHandle(check(H5Gcreate2(file, "scalars", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
                                 path_, "cannot create group scalars"));
    sample_series_ = ScalarSeries::create(scalars_.get(), path_);
  }

  void require_open() const {
    if (file_.get() < 0) throw std::logic_error(path_.string() + ": the trajectory has ended");
  }

  void require_spins(void const* spins) const {
    if (!spins) throw std::invalid_argument(path_.string() + ": the spins are a null pointer");
  }

  void write_pending() {
    sample_series_.append(pending_, path_);
    pending_.clear();
  }

  void flush() {
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), path_, "cannot write the file");
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
  FileHandle file_;
  DatasetHandle spins_;
  GroupHandle scalars_;
  ScalarSeries frame_series_, sample_series_;
  OpenFileSpace space_;
  Extents frame_extents_;
  std::uint64_t frame_bytes_ = 0;
  bool raw_chunks_ = false;
  std::vector<Sample> pending_;
  Clock::time_point flushed_ = Clock::now();
  std::int64_t frames_ = 0;
};

TrajectoryFile::TrajectoryFile(std::filesystem::path path, TrajectoryHeader const& header,
                               bool overwrite, TrajectoryStorage const& storage) {
  QuietErrors const quiet;
  implementation_ = std::make_unique<Implementation>(std::move(path), header, overwrite, storage);
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

void TrajectoryFile::write_frame_with_room(std::int64_t step, double time, Scalars const& scalars,
                                           std::byte* spins) {
  QuietErrors const quiet;
  not_moved(implementation_).write_frame_with_room({step, time, scalars}, spins);
}

void TrajectoryFile::write_scalars(std::int64_t step, double time, Scalars const& scalars) {
  QuietErrors const quiet;
  not_moved(implementation_).write_scalars({step, time, scalars});
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

}  // namespace cayspin::io
