// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scalar_series.hpp"

#include "checksum.hpp"
#include "column.hpp"
#include "hdf5/error.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_1::io {
namespace {

constexpr hsize_t samples_per_chunk = 512;
constexpr char const* sublattices_name = "sublattice_magnetization";

// Calls use(name, member) for each dataset with one number, or three, of each sample, in the order
// of the file.
template <class Use>
void for_each_column(Use const& use) {
  use("time", [](auto& sample) -> auto& { return sample.time; });
  use("step", [](auto& sample) -> auto& { return sample.step; });
  for_each_scalar([&](char const* name, auto scalar) {
    use(name, [scalar](auto& sample) -> auto& { return sample.scalars.*scalar; });
  });
}

}  // namespace

ScalarSeries ScalarSeries::create(hid_t group, std::filesystem::path const& path,
                                  std::int64_t cell_sites) {
  ScalarSeries series;
  auto const create = [&](char const* name, hid_t type, Extents const& chunk) {
    return create_growing_dataset(group, name, type, chunk, PropertyHandle(), path);
  };
  for_each_column([&](char const* name, auto const& member) {
    using Stored = Column<MemberValue<Sample, decltype(member)>>;
    series.columns_.push_back(create(name, Stored::type(), Stored::extents(samples_per_chunk)));
  });
  series.checksum_ = create("checksum", H5T_STD_U64LE, {samples_per_chunk});
  series.cell_sites_ = cell_sites;
  if (cell_sites == 1) return series;
  auto const sites = static_cast<hsize_t>(cell_sites);
  series.sublattices_ = create(sublattices_name, H5T_IEEE_F64LE,
                               {std::max<hsize_t>(1, samples_per_chunk / sites), sites, 3});
  return series;
}

ScalarSeries ScalarSeries::open(hid_t group, std::filesystem::path const& path,
                                std::int64_t cell_sites) {
  ScalarSeries series;
  for_each_column([&](char const* name, auto const& member) {
    using Stored = Column<MemberValue<Sample, decltype(member)>>;
    auto dataset = open_dataset(group, name, Stored::is_triple ? 2 : 1, path);
    if (Stored::is_triple && dataset_extents(dataset.get(), path)[1] != 3)
      throw_failure(path, std::string("cannot read dataset ") + name, "its second extent is not 3");
    series.columns_.push_back(std::move(dataset));
  });
  auto const has_checksums =
      check(H5Lexists(group, "checksum", H5P_DEFAULT), path, "cannot read dataset checksum");
  if (has_checksums > 0) series.checksum_ = open_dataset(group, "checksum", 1, path);
  series.cell_sites_ = cell_sites;
  if (cell_sites == 1) return series;
  series.sublattices_ = open_dataset(group, sublattices_name, 3, path);
  auto const extents = dataset_extents(series.sublattices_.get(), path);
  if (extents[1] != static_cast<hsize_t>(cell_sites) || extents[2] != 3)
    throw_failure(path, std::string("cannot read dataset ") + sublattices_name,
                  "its inner extents are not (" + std::to_string(cell_sites) + ", 3)");
  return series;
}

// Without the filter fletcher32: its sum would stand for a chunk of 512 samples that is written in
// pieces.
void ScalarSeries::append(std::vector<Sample> const& samples, std::filesystem::path const& path,
                          std::uint32_t spins, std::vector<Vector> const& sublattices) {
  if (samples.empty()) return;
  auto const checksums = values_of(samples, [&](Sample const& sample) {
    return std::uint64_t{row_checksum(sample, sublattices)} << 32U | spins;
  });
  hsize_t const count = samples.size();
  auto dataset = columns_.begin();
  for_each_column([&](char const*, auto const& member) {
    using Stored = Column<MemberValue<Sample, decltype(member)>>;
    append_block((dataset++)->get(), Stored::memory_type(), Stored::begin(size_),
                 Stored::extents(count), values_of(samples, member).data(), path);
  });
  if (sublattices_.get() >= 0)
    append_block(sublattices_.get(), H5T_NATIVE_DOUBLE, {size_, 0, 0},
                 {count, static_cast<hsize_t>(cell_sites_), 3}, sublattices.data(), path);
  append_block(checksum_.get(), H5T_NATIVE_UINT64, {size_}, {count}, checksums.data(), path);
  size_ += count;
}

std::int64_t ScalarSeries::size(std::filesystem::path const& path) const {
  hsize_t shortest = std::numeric_limits<std::int64_t>::max();
  auto const count = [&](DatasetHandle const& dataset) {
    if (dataset.get() >= 0) shortest = std::min(shortest, dataset_extents(dataset.get(), path)[0]);
  };
  std::ranges::for_each(columns_, count);
  count(checksum_);
  count(sublattices_);
  return static_cast<std::int64_t>(shortest);
}

bool ScalarSeries::is_readable(std::int64_t sample, std::filesystem::path const& path) const {
  try {
    return read(sample, sample + 1, path).size() == 1;
  } catch (std::runtime_error const&) {
    return false;
  }
}

std::int64_t ScalarSeries::readable(std::int64_t most_torn,
                                    std::filesystem::path const& path) const {
  auto end = size(path);
  if (most_torn == 0 || end == 0 || is_readable(end - 1, path)) return end;
  auto begin = std::max(end - most_torn, std::int64_t{0});
  for (--end; begin < end;) {
    auto const middle = begin + (end - begin) / 2;
    is_readable(middle, path) ? begin = middle + 1 : end = middle;
  }
  return end;
}

std::vector<Sample> ScalarSeries::read(std::int64_t begin, std::int64_t end,
                                       std::filesystem::path const& path) const {
  std::vector<Sample> samples(static_cast<std::size_t>(end - begin));
  if (samples.empty()) return samples;
  auto dataset = columns_.begin();
  for_each_column([&](char const*, auto const& member) {
    using Value = MemberValue<Sample, decltype(member)>;
    using Stored = Column<Value>;
    std::vector<Value> values(samples.size());
    read_block((dataset++)->get(), Stored::memory_type(),
               Stored::begin(static_cast<hsize_t>(begin)), Stored::extents(samples.size()),
               values.data(), path);
    for (std::size_t i = 0; i < samples.size(); ++i) member(samples[i]) = values[i];
  });
  if (!has_checksums()) return samples;
  auto const checksums = read_checksums(begin, end, path);
  auto const sublattices = read_sublattices(begin, end, path);
  auto const of_sample = sublattices.empty() ? 0 : static_cast<std::size_t>(cell_sites_);
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (checksums[i] >> 32U !=
        row_checksum(samples[i], std::span(sublattices).subspan(i * of_sample, of_sample)))
      throw_failure(path, "cannot read the trajectory",
                    "sample " + std::to_string(begin + static_cast<std::int64_t>(i)) +
                        " is damaged: its checksum differs");
  return samples;
}

std::vector<Vector> ScalarSeries::read_sublattices(std::int64_t begin, std::int64_t end,
                                                   std::filesystem::path const& path) const {
  if (sublattices_.get() < 0 || begin == end) return {};
  std::vector<Vector> means(static_cast<std::size_t>((end - begin) * cell_sites_));
  read_block(sublattices_.get(), H5T_NATIVE_DOUBLE, {static_cast<hsize_t>(begin), 0, 0},
             {static_cast<hsize_t>(end - begin), static_cast<hsize_t>(cell_sites_), 3},
             means.data(), path);
  return means;
}

std::uint32_t ScalarSeries::spins_checksum(std::int64_t frame,
                                           std::filesystem::path const& path) const {
  return static_cast<std::uint32_t>(read_checksums(frame, frame + 1, path).at(0));
}

std::vector<std::uint64_t> ScalarSeries::read_checksums(std::int64_t begin, std::int64_t end,
                                                        std::filesystem::path const& path) const {
  std::vector<std::uint64_t> checksums(static_cast<std::size_t>(end - begin));
  read_block(checksum_.get(), H5T_NATIVE_UINT64, {static_cast<hsize_t>(begin)}, {checksums.size()},
             checksums.data(), path);
  return checksums;
}

}  // namespace cayspin::inline v0_1::io
