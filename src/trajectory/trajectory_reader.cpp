// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "scalar_series.hpp"

#include <cayspin/io/trajectory.hpp>

#include <algorithm>
#include <string>

namespace cayspin::io {
namespace {

FileHandle open_file(std::filesystem::path const& path) {
  FileHandle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (file.get() >= 0) return file;
  auto reason = failure_reason();
  if (reason == "file signature not found") reason = "it is not an HDF5 file";
  if (reason == "Resource temporarily unavailable") reason = "another program is writing it";
  throw_failure(path, "cannot open the file", reason);
}

std::string to_text(Extents const& extents) {
  std::string text = "(";
  for (auto const extent : extents) text += std::to_string(extent) + ", ";
  return text.substr(0, std::max<std::size_t>(text.size(), 3) - 2) + ")";
}

void require_floating_point(hid_t dataset, std::string const& action,
                            std::filesystem::path const& path) {
  DatatypeHandle const type(check(H5Dget_type(dataset), path, action));
  if (H5Tget_class(type.get()) != H5T_FLOAT)
    throw_failure(path, action, "it holds no floating-point numbers");
}

// The reader of a killed run must not take the frame that was being written.
hsize_t whole_frames(hid_t file, hsize_t stored, std::filesystem::path const& path) {
  if (H5Lexists(file, "magnetization", H5P_DEFAULT) <= 0) return stored;
  auto const means = open_dataset(file, "magnetization", 2, path);
  return std::min(stored, dataset_extents(means.get(), path)[0]);
}

std::vector<double> read_values(hid_t dataset, Extents const& begin, Extents const& extents,
                                std::filesystem::path const& path) {
  std::size_t count = 1;
  for (auto const extent : extents) count *= extent;
  std::vector<double> values(count);
  if (count > 0) read_block(dataset, H5T_NATIVE_DOUBLE, begin, extents, values.data(), path);
  return values;
}

}  // namespace

TrajectoryInfo read_info(std::filesystem::path const& path) {
  QuietErrors const quiet;
  auto const file = open_file(path);
  RootAttributes const attributes(file.get(), path);
  TrajectoryInfo info;
  info.path = path;
  info.format = static_cast<int>(attributes.read_integer("format"));
  if (info.format != format_version)
    throw_failure(path, "cannot read the trajectory",
                  "its format is " + std::to_string(info.format) + "; accepted is " +
                      std::to_string(format_version));
  info.header.scene_text = attributes.read_text("scene");
  info.header.cayspin_version = attributes.read_text("cayspin_version");
  info.header.git_commit = attributes.read_text("git_commit");
  info.header.kokkos_version = attributes.read_text("kokkos_version");
  info.header.space = attributes.read_text("space");
  info.header.threads = static_cast<int>(attributes.read_integer("threads"));
  info.header.precision = attributes.read_text("precision");
  info.cost.evaluations = attributes.read_integer("evaluations");
  info.cost.wall_seconds = attributes.read_real("wall_seconds");
  info.cost.step_seconds = attributes.read_real("step_seconds");
  info.complete = attributes.read_integer("complete") == 1;

  auto const spins = open_dataset(file.get(), "spins", 5, path);
  auto const extents = dataset_extents(spins.get(), path);
  for (int axis = 0; axis < 3; ++axis)
    info.header.shape[axis] = static_cast<std::int64_t>(extents[3 - axis]);
  auto const series = ScalarSeries::open(file.get(), path);
  info.frames = std::min(static_cast<std::int64_t>(extents[0]), series.size(path));
  for (auto const& sample : series.read(info.frames, path)) {
    info.frame_steps.push_back(sample.step);
    info.frame_times.push_back(sample.time);
    info.frame_scalars.push_back(sample.scalars);
  }
  GroupHandle const scalars(
      check(H5Gopen2(file.get(), "scalars", H5P_DEFAULT), path, "cannot open group scalars"));
  info.samples = ScalarSeries::open(scalars.get(), path).size(path);
  return info;
}

StoredSpins read_spins(std::filesystem::path const& path) {
  QuietErrors const quiet;
  std::string const action = "cannot read dataset spins";
  auto const file = open_file(path);
  auto const dataset = open_dataset(file.get(), "spins", path);
  require_floating_point(dataset.get(), action, path);
  auto extents = dataset_extents(dataset.get(), path);
  auto const rank = extents.size();
  if ((rank != 4 && rank != 5) || extents.back() != 3)
    throw_failure(path, action,
                  "its extents are " + to_text(extents) +
                      "; accepted are (nz, ny, nx, 3) and (frame, nz, ny, nx, 3)");
  StoredSpins stored;
  for (int axis = 0; axis < 3; ++axis)
    stored.shape[axis] = static_cast<std::int64_t>(extents[rank - 2 - axis]);
  Extents begin(rank, 0);
  if (rank == 5) {
    auto const frames = whole_frames(file.get(), extents[0], path);
    if (frames == 0) throw_failure(path, action, "it holds no frame");
    begin[0] = frames - 1;
    extents[0] = 1;
  }
  stored.spins = read_values(dataset.get(), begin, extents, path);
  return stored;
}

StoredArray read_array(std::filesystem::path const& path, std::string const& dataset) {
  QuietErrors const quiet;
  auto const file = open_file(path);
  auto const opened = open_dataset(file.get(), dataset.c_str(), path);
  require_floating_point(opened.get(), "cannot read dataset " + dataset, path);
  auto const extents = dataset_extents(opened.get(), path);
  StoredArray array;
  array.extents.assign(extents.begin(), extents.end());
  if (extents.empty())
    throw_failure(path, "cannot read dataset " + dataset, "it is a single number, not an array");
  array.values = read_values(opened.get(), Extents(extents.size(), 0), extents, path);
  return array;
}

}  // namespace cayspin::io
