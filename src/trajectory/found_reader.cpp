// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Reads files of paths and of modes, except their vectors with numbers per site.
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/modes.hpp"
#include "io/path.hpp"
#include "require.hpp"
#include "site_order.hpp"
#include "units_of_file.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

constexpr auto path_format = "path_format", modes_format = "cayspin_modes_format";

bool has_attribute(fs::path const& path, char const* name) {
  return read_guarded(path, [&] {
    auto const file = open_file(path);
    return RootAttributes(file.get(), path).has(name);
  });
}

/// Returns all numbers of a dataset with `rank` axes.
template <class Number>
std::vector<Number> read_numbers(hid_t group, char const* name, std::size_t rank, hid_t type,
                                 fs::path const& path) {
  auto const dataset = open_dataset(group, name, rank, path);
  auto const extents = dataset_extents(dataset.get(), path);
  std::vector<Number> numbers(elements(extents));
  if (!numbers.empty())
    read_block(dataset.get(), type, Extents(rank), extents, numbers.data(), path);
  return numbers;
}

std::vector<double> read_reals(hid_t group, char const* name, fs::path const& path,
                               std::size_t rank = 1) {
  return read_numbers<double>(group, name, rank, H5T_NATIVE_DOUBLE, path);
}

std::vector<double> read_whole_saddle(fs::path const& path, TrajectoryHeader const& header) {
  auto const file = open_file(path);
  auto const saddle = read_reals(file.get(), "saddle", path, header.cell_sites > 1 ? 5 : 4);
  auto const& [nx, ny, nz] = header.shape;
  if (std::ssize(saddle) != 3 * nx * ny * nz)
    throw_failure(path, "cannot read dataset saddle", "it does not have the shape of the images");
  return by_planes(saddle, header);
}

bool has_dataset(hid_t file, char const* name) { return H5Lexists(file, name, H5P_DEFAULT) > 0; }

/// Reads the shape and the sites per cell from the extents of /spins, in which `before` extents
/// precede those of a state.
void read_lattice(hid_t file, std::size_t before, std::array<std::int64_t, 3>& shape,
                  std::int64_t& cell_sites, fs::path const& path) {
  auto extents = dataset_extents(open_dataset(file, "spins", path).get(), path);
  extents.erase(extents.begin(),
                extents.begin() + static_cast<std::ptrdiff_t>(std::min(before, extents.size())));
  cell_sites = extents.size() == 5 ? static_cast<std::int64_t>(extents[0]) : 1;
  if (extents.size() == 5) extents.erase(extents.begin());
  if (extents.size() != 4) throw_failure(path, "cannot read dataset spins", "its rank is wrong");
  for (std::size_t axis = 0; axis < 3; ++axis)
    shape[axis] = static_cast<std::int64_t>(extents[2 - axis]);
  require_lattice_of_file(shape, cell_sites, path);
  shape[2] *= cell_sites;
}

Path read_whole_path(fs::path const& path) {
  auto const file = open_file(path);
  RootAttributes const attributes(file.get(), path);
  attributes.require_version(path_format, 1, "cannot read the path");
  Path found;
  auto& header = found.header;
  header.scene_text = attributes.read_text("scene");
  header.cayspin_version = attributes.read_text("written_by");
  header.git_commit = attributes.read_text("git_commit");
  header.space = attributes.read_text("space");
  header.threads = static_cast<int>(attributes.read_integer("threads"));
  header.precision = attributes.read_text("precision");
  header.units = read_units(attributes);
  read_lattice(file.get(), 1, header.shape, header.cell_sites, path);
  found.from = attributes.read_text("from");
  found.to = attributes.read_text("to");
  found.end = attributes.read_text("end");
  found.converged = attributes.read_integer("converged") == 1;
  found.evaluations = attributes.read_integer("evaluations");
  found.wall_seconds = attributes.read_real("wall_seconds");
  found.across = attributes.read_real("across");
  found.energy = read_reals(file.get(), "energy", path);
  found.distance = read_reals(file.get(), "distance", path);
  if (found.energy.empty() || found.distance.size() != found.energy.size())
    throw_failure(path, "cannot read the path", "it does not have a distance for each energy");
  if (!attributes.has("saddle_energy")) return found;
  found.torque = attributes.read_real("torque");
  auto const group = open_group(file.get(), "saddles", path);
  auto const energy = read_reals(group.get(), "energy", path),
             curvature = read_reals(group.get(), "curvature", path),
             next = read_reals(group.get(), "next_curvature", path);
  auto const image = read_numbers<std::int64_t>(group.get(), "image", 1, H5T_NATIVE_INT64, path);
  if (energy.empty() || curvature.size() != energy.size() || next.size() != energy.size() ||
      image.size() != energy.size())
    throw_failure(path, "cannot read the path", "its saddles are not whole");
  for (std::size_t i = 0; i < energy.size(); ++i)
    found.saddles.push_back({energy[i], curvature[i], next[i], image[i]});
  if (!attributes.has("prefactor_forward")) return found;
  auto& rates = found.rates.emplace();
  rates.prefactor_forward = attributes.read_real("prefactor_forward");
  rates.prefactor_backward = attributes.read_real("prefactor_backward");
  rates.langer_forward = attributes.read_real("langer_forward");
  rates.langer_backward = attributes.read_real("langer_backward");
  auto const modes =
      read_numbers<std::int64_t>(file.get(), "zero_modes", 1, H5T_NATIVE_INT64, path);
  auto const volumes = read_reals(file.get(), "zero_mode_volumes", path);
  std::copy_n(modes.begin(), std::min<std::size_t>(3, modes.size()), rates.zero_modes.begin());
  std::copy_n(volumes.begin(), std::min<std::size_t>(3, volumes.size()), rates.volumes.begin());
  return found;
}

BandsContents read_whole_modes(fs::path const& path) {
  auto const file = open_file(path);
  RootAttributes const attributes(file.get(), path);
  attributes.require_version(modes_format, 1, "cannot read the modes");
  BandsContents found;
  found.scene_text = attributes.read_text("scene");
  found.cayspin_version = attributes.read_text("cayspin_version");
  found.git_commit = attributes.read_text("git_commit");
  found.precision = attributes.read_text("precision");
  found.space = attributes.read_text("space");
  found.units = read_units(attributes);
  found.torque = attributes.read_real("torque");
  found.evaluations = attributes.read_integer("evaluations");
  found.converged = attributes.read_integer("converged") == 1;
  read_lattice(file.get(), 0, found.shape, found.cell_sites, path);
  bool const has_waves = has_dataset(file.get(), "wave_vector");
  std::size_t const rank = has_waves ? 2 : 1;
  found.frequencies = read_reals(file.get(), "frequency", path, rank);
  found.decays = read_reals(file.get(), "decay", path, rank);
  if (!has_waves) found.residuals = read_reals(file.get(), "residual", path);
  if (found.decays.size() != found.frequencies.size() ||
      (!has_waves && found.residuals.size() != found.frequencies.size()))
    throw_failure(path, "cannot read the modes", "they do not have a decay each");
  for (auto const& [name, numbers] : {std::pair{"curvature", &found.curvatures},
                                      {"curvature_error", &found.curvature_errors},
                                      {"curvature_residual", &found.curvature_residuals}})
    if (has_dataset(file.get(), name)) *numbers = read_reals(file.get(), name, path);
  for (auto const* const numbers : {&found.curvature_errors, &found.curvature_residuals})
    if (!numbers->empty() && numbers->size() != found.curvatures.size())
      throw_failure(path, "cannot read the modes", "the curvatures do not have an error each");
  if (!has_waves) return found;
  auto const numbers = read_reals(file.get(), "wave_vector", path, 2);
  for (std::size_t i = 0; i + 2 < numbers.size(); i += 3)
    found.wave_vectors.push_back({numbers[i], numbers[i + 1], numbers[i + 2]});
  if (found.wave_vectors.empty() || found.frequencies.size() % found.wave_vectors.size() != 0)
    throw_failure(path, "cannot read the modes", "its waves are not whole");
  return found;
}

}  // namespace

bool is_path(fs::path const& path) { return has_attribute(path, path_format); }
Path read_path(fs::path const& path) {
  return read_guarded(path, [&] { return read_whole_path(path); });
}

std::size_t negative_curvatures(ModesContents const& contents) {
  auto const& errors = contents.curvature_errors;
  std::size_t count = 0;
  for (std::size_t i = 0; i < errors.size(); ++i)
    count += contents.curvatures[i] < -errors[i] ? 1 : 0;
  return count;
}

std::vector<double> read_saddle(fs::path const& path, TrajectoryHeader const& header) {
  return read_guarded(path, [&] { return read_whole_saddle(path, header); });
}

bool is_modes(fs::path const& path) { return has_attribute(path, modes_format); }
BandsContents read_modes(fs::path const& path) {
  return read_guarded(path, [&] { return read_whole_modes(path); });
}

}  // namespace cayspin::inline v0_2::io
