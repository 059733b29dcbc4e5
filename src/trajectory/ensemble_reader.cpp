// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "checksum.hpp"
#include "ensemble_format.hpp"
#include "fletcher32.hpp"
#include "format.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"
#include "hdf5/guarded_reading.hpp"
#include "io/ensemble_file.hpp"
#include "require.hpp"
#include "site_order.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string>

namespace cayspin::inline v0_2::io {
namespace {

std::vector<double> read_row(hid_t file, char const* name, Extents const& begin,
                             Extents const& extents, std::filesystem::path const& path) {
  auto const dataset = open_dataset(file, name, begin.size(), path);
  std::vector<double> values(elements(extents));
  read_block(dataset.get(), H5T_NATIVE_DOUBLE, begin, extents, values.data(), path);
  return values;
}

hsize_t length_of(hid_t group, char const* name, std::filesystem::path const& path) {
  auto const dataset = open_dataset(group, name, path);
  auto const extents = dataset_extents(dataset.get(), path);
  return extents.empty() ? 0 : extents[0];
}

bool group_has(hid_t group, char const* name) { return H5Lexists(group, name, H5P_DEFAULT) > 0; }

// Returns the checksums of replicas in a frame; empty for a file of an earlier version.
std::vector<std::uint64_t> read_checksums(hid_t file, hsize_t frame, ReplicaRange const& replicas,
                                          std::filesystem::path const& path) {
  if (!group_has(file, checksum_of_replicas)) return {};
  auto const dataset = open_dataset(file, checksum_of_replicas, 2, path);
  std::vector<std::uint64_t> sums(static_cast<std::size_t>(replicas.count));
  read_block(dataset.get(), H5T_NATIVE_UINT64, {frame, static_cast<hsize_t>(replicas.first)},
             {1, sums.size()}, sums.data(), path);
  return sums;
}

[[noreturn]] void refuse_damaged(char const* dataset, std::int64_t frame, std::int64_t replica,
                                 std::filesystem::path const& path) {
  throw_failure(path, std::string("cannot read dataset ") + dataset,
                "replica " + std::to_string(replica) + " of frame " + std::to_string(frame) +
                    " is damaged: its checksum differs");
}

constexpr char const* names_of_series[] = {"time", "step", "energy", "norm_defect",
                                           "magnetization"};

// Returns true if a row of a group reached the disk. The energy is not examined, because that of a
// program's own field may be NaN.
bool is_on_disk(hid_t group, hsize_t row, hsize_t replicas, std::filesystem::path const& path) {
  auto const has = [&](char const* name, Extents const& of_row) {
    Extents begin(of_row.size() + 1), extents(of_row);
    begin[0] = row;
    extents.insert(extents.begin(), 1);
    return std::ranges::none_of(read_row(group, name, begin, extents, path),
                                [](double number) { return std::isnan(number); });
  };
  // No stored checksum is 0.
  auto const sums = read_checksums(group, row, {0, static_cast<std::int64_t>(replicas)}, path);
  return std::ranges::find(sums, 0U) == sums.end() &&
         read_row(group, "step", {row}, {1}, path)[0] != missing_step && has("time", {}) &&
         has("norm_defect", {replicas}) && has("magnetization", {replicas, 3});
}

// Returns the number of whole rows in a group, at most `most`. A process that was killed while it
// added rows, or is adding some, may leave the last ones in only some of the datasets, or without
// their numbers.
std::int64_t whole_rows(hid_t group, hsize_t replicas, hsize_t most,
                        std::filesystem::path const& path) {
  auto rows = most;
  for (auto const* const name : names_of_series)
    rows = std::min(rows, length_of(group, name, path));
  for (auto const* const name : {sublattices_of_replicas, checksum_of_replicas})
    if (group_has(group, name)) rows = std::min(rows, length_of(group, name, path));
  while (rows > 0 && !is_on_disk(group, rows - 1, replicas, path)) --rows;
  return static_cast<std::int64_t>(rows);
}

void read_spins_extents(hid_t file, EnsembleInfo& info, std::filesystem::path const& path) {
  auto const dataset = open_dataset(file, "spins", path);
  auto const extents = dataset_extents(dataset.get(), path);
  bool const has_sites = extents.size() == 7;
  bool const fits = (extents.size() == 6 || has_sites) && extents.back() == 3 && extents[1] > 0 &&
                    extents[1] == static_cast<hsize_t>(info.ensemble.replicas);
  if (!fits)
    throw_failure(path, "cannot read dataset spins", "its extents are not those of the replicas");
  auto& header = info.header;
  header.cell_sites = has_sites ? static_cast<std::int64_t>(extents[2]) : 1;
  for (std::size_t axis = 0; axis < 3; ++axis)
    header.shape[axis] = static_cast<std::int64_t>(extents[extents.size() - 2 - axis]);
  require_lattice_of_file(header.shape, header.cell_sites, path);
  header.shape[2] *= header.cell_sites;
  info.frames = static_cast<std::int64_t>(extents[0]);
}

// Reads the last frame of all replicas except its spins. Returns the first replica whose numbers
// differ from their checksum, if there is one.
std::optional<std::int64_t> read_last_frame(hid_t file, EnsembleInfo& info,
                                            std::filesystem::path const& path) {
  auto const replicas = static_cast<hsize_t>(info.ensemble.replicas);
  auto const sites = static_cast<hsize_t>(info.header.cell_sites);
  auto const last = static_cast<hsize_t>(info.frames) - 1;
  info.step = static_cast<std::int64_t>(read_row(file, "step", {last}, {1}, path)[0]);
  info.time = read_row(file, "time", {last}, {1}, path)[0];
  auto const energy = read_row(file, "energy", {last, 0}, {1, replicas}, path),
             defect = read_row(file, "norm_defect", {last, 0}, {1, replicas}, path),
             mean = read_row(file, "magnetization", {last, 0, 0}, {1, replicas, 3}, path);
  std::vector<double> sublattices;
  if (sites > 1 && group_has(file, sublattices_of_replicas))
    sublattices =
        read_row(file, sublattices_of_replicas, {last, 0, 0, 0}, {1, replicas, sites, 3}, path);
  auto const sums = read_checksums(file, last, {0, info.ensemble.replicas}, path);
  auto const width = sublattices.size() / replicas;
  info.last.clear();
  info.last_sublattices.clear();
  std::optional<std::int64_t> damaged;
  for (std::size_t r = 0; r < replicas; ++r) {
    info.last.push_back({energy[r], defect[r], {mean[3 * r], mean[3 * r + 1], mean[3 * r + 2]}});
    auto const more = std::span<double const>(sublattices).subspan(r * width, width);
    for (std::size_t i = 0; i < width; i += 3)
      info.last_sublattices.push_back({more[i], more[i + 1], more[i + 2]});
    bool const differs =
        !sums.empty() &&
        sums[r] >> 32U != row_checksum({info.step, info.time, info.last.back()}, more);
    if (differs && !damaged) damaged = static_cast<std::int64_t>(r);
  }
  return damaged;
}

// If the last frame of a run that has not ended differs from its checksums, takes the frame before.
void read_last_whole_frame(hid_t file, EnsembleInfo& info, std::filesystem::path const& path) {
  for (; info.frames > 0; --info.frames) {
    auto const damaged = read_last_frame(file, info, path);
    if (!damaged) return;
    if (info.complete) refuse_damaged("energy", info.frames - 1, *damaged, path);
  }
  info.step = 0;
  info.time = 0;
  info.last.clear();
  info.last_sublattices.clear();
}

EnsembleInfo read_whole_ensemble(std::filesystem::path const& path, Locking locking) {
  auto const file = open_file(path, locking);
  RootAttributes const attributes(file.get(), path);
  attributes.require_version(ensemble_format, ensemble_format_version, "cannot read the ensemble");
  EnsembleInfo info;
  auto& header = info.header;
  header.scene_text = attributes.read_text("scene");
  header.cayspin_version = attributes.read_text("written_by");
  header.git_commit = attributes.read_text("git_commit");
  header.kokkos_version = attributes.read_text("kokkos_version");
  header.space = attributes.read_text("space");
  header.threads = static_cast<int>(attributes.read_integer("threads"));
  header.precision = attributes.read_text("precision");
  header.units.si = attributes.read_word("units", si_units, reduced_units);
  if (header.units.si)
    for (auto const& [name, member] : unit_attributes)
      header.units.*member = attributes.read_real(name);
  info.ensemble.replicas = attributes.read_integer("replicas");
  info.cost = {attributes.read_integer("evaluations"), attributes.read_real("wall_seconds"),
               attributes.read_real("step_seconds")};
  info.complete = attributes.read_integer("complete") == 1;
  read_spins_extents(file.get(), info, path);
  auto const replicas = static_cast<hsize_t>(info.ensemble.replicas);
  info.frames = whole_rows(file.get(), replicas, static_cast<hsize_t>(info.frames), path);
  info.samples = whole_rows(open_group(file.get(), "scalars", path).get(), replicas,
                            std::numeric_limits<std::int64_t>::max(), path);
  auto const vary = open_group(file.get(), "vary", path);
  if (H5Aexists(vary.get(), "keys") > 0)
    for (auto const& key : read_names(vary.get(), "keys", path))
      info.ensemble.vary.push_back({key, read_row(vary.get(), key.c_str(), {0}, {replicas}, path)});
  if (group_has(file.get(), "converged")) {
    auto const torque = read_row(file.get(), "torque", {0}, {replicas}, path),
               converged = read_row(file.get(), "converged", {0}, {replicas}, path),
               evaluations = read_row(file.get(), "evaluations", {0}, {replicas}, path);
    for (std::size_t r = 0; r < replicas; ++r)
      info.relaxed.push_back(
          {torque[r], converged[r] == 1, static_cast<std::int64_t>(evaluations[r])});
  }
  read_last_whole_frame(file.get(), info, path);
  return info;
}

// Compares the spins of replicas in the last frame, in file order, with their checksums.
void require_undamaged(hid_t file, EnsembleInfo const& info, ReplicaRange const& replicas,
                       std::vector<double> const& spins, std::filesystem::path const& path) {
  auto const frame = info.frames - 1;
  auto const sums = read_checksums(file, static_cast<hsize_t>(frame), replicas, path);
  if (sums.empty()) return;
  auto const size = spins.size() / sums.size();
  for (std::size_t number = 0; number < sums.size(); ++number) {
    auto const replica = replicas.first + static_cast<std::int64_t>(number);
    auto const own = std::span<double const>(spins).subspan(number * size, size);
    // The sum is that of the stored type, because floats were read as double.
    auto const sum = info.header.precision == single_precision
                         ? fletcher32(std::as_bytes(
                               std::span<float const>(std::vector<float>(own.begin(), own.end()))))
                         : fletcher32(std::as_bytes(own));
    auto const& scalars = info.last.at(static_cast<std::size_t>(replica));
    if (static_cast<std::uint32_t>(sums[number]) !=
        spins_checksum({info.step, info.time, scalars}, sum))
      refuse_damaged("spins", frame, replica, path);
  }
}

std::vector<double> read_last_spins(std::filesystem::path const& path, EnsembleInfo const& info,
                                    ReplicaRange const& replicas) {
  auto const file = open_file(path);
  auto const dataset = open_dataset(file.get(), "spins", path);
  auto extents = dataset_extents(dataset.get(), path);
  Extents begin(extents.size(), 0);
  begin[0] = static_cast<hsize_t>(info.frames) - 1;
  extents[0] = 1;
  begin[1] = static_cast<hsize_t>(replicas.first);
  extents[1] = static_cast<hsize_t>(replicas.count);
  std::vector<double> spins(elements(extents));
  read_block(dataset.get(), H5T_NATIVE_DOUBLE, begin, extents, spins.data(), path);
  require_undamaged(file.get(), info, replicas, spins, path);
  return by_planes(spins, info.header);
}

}  // namespace

bool is_ensemble(std::filesystem::path const& path) {
  QuietErrors const quiet;
  return read_guarded(path, [&] {
    auto const file = open_file(path);
    return RootAttributes(file.get(), path).has(ensemble_format);
  });
}

EnsembleInfo read_ensemble_info(std::filesystem::path const& path) {
  return read_guarded(path, [&] { return read_whole_ensemble(path, Locking::on); });
}

std::optional<EnsembleInfo> read_ensemble_info_while_written(std::filesystem::path const& path) {
  return read_guarded(path, [&]() -> std::optional<EnsembleInfo> {
    if (!RootAttributes(open_file(path, Locking::off).get(), path).has(ensemble_format))
      return std::nullopt;
    return read_whole_ensemble(path, Locking::off);
  });
}

std::vector<double> read_ensemble_spins(std::filesystem::path const& path, EnsembleInfo const& info,
                                        ReplicaRange const& replicas) {
  if (info.frames == 0) throw_failure(path, "cannot read dataset spins", "there is no frame");
  return read_guarded(path, [&] { return read_last_spins(path, info, replicas); });
}

}  // namespace cayspin::inline v0_2::io
