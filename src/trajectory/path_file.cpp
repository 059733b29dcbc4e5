// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "io/path.hpp"
#include "new_file.hpp"
#include "open_file_space.hpp"
#include "site_order.hpp"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

constexpr std::int64_t path_format_version = 1;

void write_numbers(hid_t group, char const* name, Extents const& extents,
                   std::vector<double> const& numbers, std::filesystem::path const& path,
                   hid_t type = H5T_IEEE_F64LE) {
  write_dataset(group, name, type, H5T_NATIVE_DOUBLE, extents, numbers.data(), path);
}

void write_whole_numbers(hid_t group, char const* name, std::vector<std::int64_t> const& numbers,
                         std::filesystem::path const& path) {
  write_dataset(group, name, H5T_STD_I64LE, H5T_NATIVE_INT64, {numbers.size()}, numbers.data(),
                path);
}

void write_attributes(hid_t file, Path const& found, std::filesystem::path const& path) {
  auto const& header = found.header;
  RootAttributes const attributes(file, path);
  attributes.create("path_format", path_format_version);
  attributes.create("scene", header.scene_text);
  attributes.create("from", found.from);
  attributes.create("to", found.to);
  // The attribute is not called `cayspin_version`, because readers take a file that has frames and
  // an attribute of that name for a trajectory.
  attributes.create("written_by", "cayspin " + header.cayspin_version);
  attributes.create("git_commit", header.git_commit);
  attributes.create("space", header.space);
  attributes.create("threads", std::int64_t{header.threads});
  attributes.create("precision", header.precision);
  attributes.create("units", std::string(header.units.si ? si_units : reduced_units));
  if (header.units.si)
    for (auto const& [name, member] : unit_attributes)
      attributes.create(name, header.units.*member);
  attributes.create("end", found.end);
  attributes.create("converged", std::int64_t{found.converged});
  attributes.create("evaluations", found.evaluations);
  attributes.create("wall_seconds", found.wall_seconds);
  attributes.create("across", found.across);
  if (found.saddles.empty()) return;
  attributes.create("torque", found.torque);
  attributes.create("saddle_energy", found.saddles.front().energy);
  attributes.create("barrier_forward", found.barrier_forward());
  attributes.create("barrier_backward", found.barrier_backward());
  attributes.create("saddle_curvature", found.saddles.front().curvature);
  if (!found.rates) return;
  attributes.create("prefactor_forward", found.rates->prefactor_forward);
  attributes.create("prefactor_backward", found.rates->prefactor_backward);
  attributes.create("langer_forward", found.rates->langer_forward);
  attributes.create("langer_backward", found.rates->langer_backward);
}

void write_saddles(hid_t file, Path const& found, std::filesystem::path const& path) {
  auto const group = create_group(file, "saddles", path);
  std::vector<double> energy, curvature, next;
  std::vector<std::int64_t> image;
  for (auto const& saddle : found.saddles) {
    energy.push_back(saddle.energy);
    curvature.push_back(saddle.curvature);
    next.push_back(saddle.next_curvature);
    image.push_back(saddle.image);
  }
  write_numbers(group.get(), "energy", {energy.size()}, energy, path);
  write_numbers(group.get(), "curvature", {curvature.size()}, curvature, path);
  write_numbers(group.get(), "next_curvature", {next.size()}, next, path);
  write_whole_numbers(group.get(), "image", image, path);
}

void write_datasets(hid_t file, Path const& found, std::filesystem::path const& path) {
  auto const& header = found.header;
  auto const sites = header.cell_sites;
  Extents state{static_cast<hsize_t>(header.shape[2] / sites),
                static_cast<hsize_t>(header.shape[1]), static_cast<hsize_t>(header.shape[0]), 3};
  if (sites > 1) state.insert(state.begin(), static_cast<hsize_t>(sites));
  Extents images = state;
  images.insert(images.begin(), found.energy.size());
  hid_t const type = header.precision == single_precision ? H5T_IEEE_F32LE : H5T_IEEE_F64LE;
  write_numbers(file, "spins", images, by_sites(found.spins, header), path, type);
  write_numbers(file, "energy", {found.energy.size()}, found.energy, path);
  write_numbers(file, "distance", {found.distance.size()}, found.distance, path);
  if (found.saddles.empty()) return;
  write_numbers(file, "saddle", state, by_sites(found.saddle, header), path, type);
  write_saddles(file, found, path);
  if (!found.rates) return;
  auto const& modes = found.rates->zero_modes;
  auto const& volumes = found.rates->volumes;
  write_whole_numbers(file, "zero_modes", {modes.begin(), modes.end()}, path);
  write_numbers(file, "zero_mode_volumes", {volumes.size()}, {volumes.begin(), volumes.end()},
                path);
}

}  // namespace

void write_path(std::filesystem::path const& path, Path const& found, bool overwrite) {
  QuietErrors const quiet;
  NewFile file(path, overwrite);
  OpenFileSpace space(file.get(), path);
  space.reserve((1 << 20) + 8 * (found.spins.size() + found.saddle.size()) +
                    2 * found.header.scene_text.size(),
                path);
  write_attributes(file.get(), found, path);
  write_datasets(file.get(), found, path);
  check(H5Fflush(file.get(), H5F_SCOPE_GLOBAL), path, "cannot write the file");
  space.trim();
  auto handle = file.commit();
  check(handle.close(), path, "cannot close the file");
}

void require_writable(std::filesystem::path const& path, bool overwrite) {
  QuietErrors const quiet;
  NewFile const file(path, overwrite);
}

}  // namespace cayspin::inline v0_2::io
