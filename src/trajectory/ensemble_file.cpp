// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "io/ensemble_file.hpp"

#include "checksum.hpp"
#include "ensemble_format.hpp"
#include "fletcher32.hpp"
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "new_file.hpp"
#include "open_file_space.hpp"
#include "positions.hpp"
#include "replica_series.hpp"
#include "require.hpp"
#include "site_order.hpp"
#include "sublattice_mean.hpp"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <span>
#include <stdexcept>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::uint64_t overhead = 1 << 20;  // bytes for index nodes and new chunks of scalars

void write_attributes(hid_t file, TrajectoryHeader const& header, std::int64_t replicas,
                      std::filesystem::path const& path) {
  RootAttributes const attributes(file, path);
  attributes.create(ensemble_format, ensemble_format_version);
  attributes.create("replicas", replicas);
  attributes.create("scene", header.scene_text);
  // The attribute is not called `cayspin_version`, because readers take a file that has frames and
  // an attribute of that name for a trajectory.
  attributes.create("written_by", "cayspin " + header.cayspin_version);
  attributes.create("git_commit", header.git_commit);
  attributes.create("kokkos_version", header.kokkos_version);
  attributes.create("space", header.space);
  attributes.create("threads", std::int64_t{header.threads});
  attributes.create("precision", header.precision);
  attributes.create("units", std::string(header.units.si ? si_units : reduced_units));
  if (header.units.si)
    for (auto const& [name, member] : unit_attributes)
      attributes.create(name, header.units.*member);
  attributes.create("evaluations", std::int64_t{0});
  attributes.create("wall_seconds", 0.0);
  attributes.create("step_seconds", 0.0);
  attributes.create("complete", std::int64_t{0});
}

void write_varied(hid_t file, Ensemble const& ensemble, std::filesystem::path const& path) {
  auto const group = create_group(file, "vary", path);
  std::vector<std::string> names;
  for (auto const& [key, values] : ensemble.vary) {
    write_dataset(group.get(), key.c_str(), H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {values.size()},
                  values.data(), path);
    names.push_back(key);
  }
  if (!names.empty()) write_names(group.get(), "keys", names, path);
}

/// Returns (replica, nz, ny, nx, 3), or (replica, site, nz, ny, nx, 3) for a crystal with several
/// sites per cell.
Extents extents_of_frame(TrajectoryHeader const& header, hsize_t replicas) {
  auto const sites = static_cast<hsize_t>(header.cell_sites);
  Extents extents{replicas};
  if (sites > 1) extents.push_back(sites);
  extents.push_back(static_cast<hsize_t>(header.shape[2]) / sites);
  extents.insert(extents.end(),
                 {static_cast<hsize_t>(header.shape[1]), static_cast<hsize_t>(header.shape[0]), 3});
  return extents;
}

DatasetHandle create_spins(hid_t file, TrajectoryHeader const& header, hsize_t replicas,
                           TrajectoryStorage const& storage, std::filesystem::path const& path) {
  constexpr hsize_t chunk_bytes = 4 << 20;
  auto const inner = extents_of_frame(header, replicas);
  bool const single = header.precision == single_precision;
  auto const of_replica = elements(inner) / replicas * (single ? 4 : 8);
  Extents chunk{1};
  chunk.insert(chunk.end(), inner.begin(), inner.end());
  chunk[1] = std::clamp<hsize_t>(chunk_bytes / of_replica, 1, replicas);
  // A replica that would exceed the largest chunk in double precision is cut along its axes, the
  // slowest first.
  for (std::size_t axis = 2; axis + 1 < chunk.size(); ++axis)
    while (elements(chunk) * 8 > most_chunk_bytes && chunk[axis] > 1)
      chunk[axis] = (chunk[axis] + 1) / 2;
  if (storage.compression == 0) {
    auto const of_chunk = elements(chunk) * (single ? 4 : 8);
    auto const chunks = (replicas + chunk[1] - 1) / chunk[1];
    chunk[0] = static_cast<hsize_t>(
        frames_of_chunk(of_chunk, storage.frames * static_cast<std::int64_t>(chunks)));
  }
  auto properties = filled_with(missing_number, path);
  constexpr char const* action = "cannot create dataset spins";
  if (storage.compression > 0) {
    check(H5Pset_shuffle(properties.get()), path, action);
    check(H5Pset_deflate(properties.get(), static_cast<unsigned>(storage.compression)), path,
          action);
  }
  return create_growing_dataset(file, "spins", single ? H5T_IEEE_F32LE : H5T_IEEE_F64LE, chunk,
                                std::move(properties), path, inner);
}

// Returns the bytes that a frame may take in the file. If chunks hold several frames, the first
// frame of a chunk takes the space of the whole chunk.
std::uint64_t bytes_of_chunks(hid_t spins, Extents const& inner, std::uint64_t number_bytes,
                              std::filesystem::path const& path) {
  PropertyHandle const properties(H5Dget_create_plist(spins));
  Extents chunk(inner.size() + 1);
  check(H5Pget_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), path,
        "cannot read the chunks of spins");
  auto bytes = number_bytes * chunk[0];
  for (std::size_t axis = 0; axis < inner.size(); ++axis)
    bytes *= (inner[axis] + chunk[axis + 1] - 1) / chunk[axis + 1] * chunk[axis + 1];
  return bytes;
}

template <class Real>
std::vector<Real> in_file_order(std::vector<std::byte> const& bytes,
                                TrajectoryHeader const& header) {
  std::vector<Real> spins(bytes.size() / sizeof(Real));
  std::memcpy(spins.data(), bytes.data(), bytes.size());
  return by_sites(spins, header);
}

// Appends the mean of each sublattice of a replica. `spins`: those of the replica, in file order.
template <class Real>
void add_sublattices(std::span<Real const> spins, TrajectoryHeader const& header,
                     std::vector<double>& means) {
  auto const nx = header.shape[0];
  auto const rows = header.shape[1] * header.shape[2] / header.cell_sites;
  auto const* row = spins.data();
  for (std::int64_t site = 0; site < header.cell_sites; ++site) {
    SublatticeMean mean;
    for (std::int64_t k = 0; k < rows; ++k, row += 3 * nx) mean.add_row(row, nx);
    auto const value = mean.value();
    means.insert(means.end(), value.begin(), value.end());
  }
}

// `spins`: those of all replicas, in file order.
template <class Real>
ReplicaFrame replica_frame(std::int64_t step, double time, std::vector<Scalars> const& scalars,
                           std::span<Real const> spins, TrajectoryHeader const& header) {
  ReplicaFrame frame;
  auto const size = spins.size() / scalars.size();
  for (std::size_t replica = 0; replica < scalars.size(); ++replica) {
    auto const own = spins.subspan(replica * size, size);
    auto const before = frame.sublattices.size();
    if (header.cell_sites > 1) add_sublattices(own, header, frame.sublattices);
    frame.checksums.push_back(
        frame_checksum({step, time, scalars[replica]}, fletcher32(std::as_bytes(own)),
                       std::span<double const>(frame.sublattices).subspan(before)));
  }
  return frame;
}

}  // namespace

class EnsembleFile::Implementation {
  using Clock = std::chrono::steady_clock;
  static constexpr auto longest_wait = std::chrono::seconds(1);

 public:
  Implementation(std::filesystem::path path, TrajectoryHeader const& header,
                 Ensemble const& ensemble, RunOutputOptions const& options)
      : path_(std::move(path)),
        header_(header),
        replicas_(static_cast<hsize_t>(ensemble.replicas)),
        frame_bytes_(elements(extents_of_frame(header, replicas_)) *
                     (header.precision == single_precision ? sizeof(float) : sizeof(double))) {
    require_precision(header.precision);
    require_shape(header.shape);
    NewFile file(path_, options.overwrite);
    space_ = OpenFileSpace(file.get(), path_);
    space_.reserve(
        overhead + header.scene_text.size() +
            sizeof(double) * (replicas_ * (ensemble.vary.size() + 8) + options.positions.size()),
        path_);
    write_attributes(file.get(), header, ensemble.replicas, path_);
    write_varied(file.get(), ensemble, path_);
    if (!options.positions.empty()) write_positions(file.get(), header, options.positions, path_);
    spins_ = create_spins(file.get(), header, replicas_, options.storage, path_);
    auto const extents = extents_of_frame(header, replicas_);
    bytes_of_chunks_ =
        bytes_of_chunks(spins_.get(), extents, frame_bytes_ / elements(extents), path_);
    frames_ =
        ReplicaSeries::create_of_frames(file.get(), ensemble.replicas, header.cell_sites, path_);
    scalars_ = create_group(file.get(), "scalars", path_);
    samples_ = ReplicaSeries::create(scalars_.get(), ensemble.replicas, path_);
    check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), path_, "cannot create the file");
    file_ = file.commit();
  }
  ~Implementation() {
    QuietErrors const quiet;
    release();
  }

  // Readers count a frame once all its scalars are there, so the scalars reach the file after the
  // spins.
  void write_frame(std::int64_t step, double time, std::vector<Scalars> const& scalars,
                   std::vector<std::byte> const& spins) {
    require_replicas(scalars.size());
    if (spins.size() != frame_bytes_)
      throw std::logic_error(path_.string() + ": spins of another lattice or precision");
    auto const sites = static_cast<std::uint64_t>(header_.cell_sites);
    space_.reserve(bytes_of_chunks_ + overhead + (72 + 24 * sites) * replicas_, path_);
    auto const frame = header_.precision == single_precision
                           ? write_spins<float>(H5T_NATIVE_FLOAT, step, time, scalars, spins)
                           : write_spins<double>(H5T_NATIVE_DOUBLE, step, time, scalars, spins);
    flush();
    frames_.append(step, time, scalars, frame, path_);
    flush();
    ++written_;
  }

  void write_scalars(std::int64_t step, double time, std::vector<Scalars> const& scalars) {
    require_replicas(scalars.size());
    space_.reserve(overhead + 64 * replicas_, path_);
    samples_.append(step, time, scalars, path_);
    if (Clock::now() - flushed_ >= longest_wait) flush();
  }

  void write_relaxed(std::vector<RelaxedReplica> const& replicas) {
    require_replicas(replicas.size());
    std::vector<double> torques;
    std::vector<std::int64_t> converged, evaluations;
    for (auto const& one : replicas) {
      torques.push_back(one.torque);
      converged.push_back(one.converged ? 1 : 0);
      evaluations.push_back(one.evaluations);
    }
    space_.reserve(overhead + 24 * replicas_, path_);
    write_dataset(file_.get(), "torque", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {replicas_},
                  torques.data(), path_);
    write_dataset(file_.get(), "converged", H5T_STD_I64LE, H5T_NATIVE_INT64, {replicas_},
                  converged.data(), path_);
    write_dataset(file_.get(), "evaluations", H5T_STD_I64LE, H5T_NATIVE_INT64, {replicas_},
                  evaluations.data(), path_);
  }

  void end(RunCost const& cost, bool complete) {
    require_open();
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

  std::int64_t frames() const { return written_; }

 private:
  template <class Real>
  ReplicaFrame write_spins(hid_t memory_type, std::int64_t step, double time,
                           std::vector<Scalars> const& scalars,
                           std::vector<std::byte> const& spins) {
    Extents begin(extents_of_frame(header_, replicas_).size() + 1);
    begin[0] = static_cast<hsize_t>(written_);
    auto extents = extents_of_frame(header_, replicas_);
    extents.insert(extents.begin(), 1);
    auto const sorted = in_file_order<Real>(spins, header_);
    append_block(spins_.get(), memory_type, begin, extents, sorted.data(), path_);
    return replica_frame<Real>(step, time, scalars, sorted, header_);
  }
  void require_open() const {
    if (file_.get() < 0) throw std::logic_error(path_.string() + ": the trajectory has ended");
  }
  void require_replicas(std::size_t count) const {
    require_open();
    if (count != replicas_)
      throw std::logic_error(path_.string() + ": numbers of " + std::to_string(count) +
                             " replicas; accepted: " + std::to_string(replicas_));
  }
  void flush() {
    check(H5Fflush(file_.get(), H5F_SCOPE_GLOBAL), path_, "cannot write the file");
    flushed_ = Clock::now();
  }
  herr_t release() {
    if (file_.get() >= 0) space_.trim();
    spins_.close();
    frames_ = {};
    samples_ = {};
    scalars_.close();
    return file_.close();
  }

  std::filesystem::path path_;
  TrajectoryHeader header_;
  hsize_t replicas_;
  std::size_t frame_bytes_;
  std::uint64_t bytes_of_chunks_ = 0;
  FileHandle file_;
  DatasetHandle spins_;
  GroupHandle scalars_;
  ReplicaSeries frames_, samples_;
  OpenFileSpace space_;
  std::int64_t written_ = 0;
  Clock::time_point flushed_ = Clock::now();
};

EnsembleFile::EnsembleFile(std::filesystem::path path, TrajectoryHeader const& header,
                           Ensemble const& ensemble, RunOutputOptions const& options) {
  QuietErrors const quiet;
  implementation_ = std::make_unique<Implementation>(std::move(path), header, ensemble, options);
}
EnsembleFile::~EnsembleFile() = default;
EnsembleFile::EnsembleFile(EnsembleFile&&) noexcept = default;

void EnsembleFile::write_frame(std::int64_t step, double time, std::vector<Scalars> const& scalars,
                               std::vector<std::byte> const& spins) {
  QuietErrors const quiet;
  not_moved(implementation_).write_frame(step, time, scalars, spins);
}
void EnsembleFile::write_scalars(std::int64_t step, double time,
                                 std::vector<Scalars> const& scalars) {
  QuietErrors const quiet;
  not_moved(implementation_).write_scalars(step, time, scalars);
}
void EnsembleFile::write_relaxed(std::vector<RelaxedReplica> const& replicas) {
  QuietErrors const quiet;
  not_moved(implementation_).write_relaxed(replicas);
}
void EnsembleFile::finish(RunCost const& cost) {
  QuietErrors const quiet;
  not_moved(implementation_).end(cost, true);
}
void EnsembleFile::close(RunCost const& cost) {
  QuietErrors const quiet;
  not_moved(implementation_).end(cost, false);
}
std::int64_t EnsembleFile::frames() const { return not_moved(implementation_).frames(); }

}  // namespace cayspin::inline v0_2::io
