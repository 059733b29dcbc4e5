// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scalar_series.hpp"

#include "checksum.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <tuple>
#include <type_traits>

namespace cayspin::inline v0_1::io {
namespace {

constexpr hsize_t samples_per_chunk = 512;
constexpr char const* sublattices_name = "sublattice_magnetization";

// Of so many rows: of numbers, or of three each.
template <class Value>
Extents extents_of(std::size_t rows) {
  if constexpr (std::is_arithmetic_v<Value>)
    return {rows};
  else
    return {rows, std::tuple_size_v<Value>};
}

template <class Value>
DatasetHandle create_column(hid_t group, char const* name, hid_t type,
                            std::filesystem::path const& path) {
  return create_growing_dataset(group, name, type, extents_of<Value>(samples_per_chunk),
                                PropertyHandle(), path);
}

template <class Member>
auto column(std::vector<Sample> const& samples, Member const& member) {
  std::vector<std::decay_t<decltype(member(samples.front()))>> values;
  values.reserve(samples.size());
  for (auto const& sample : samples) values.push_back(member(sample));
  return values;
}

template <class Value>
void append_column(DatasetHandle const& dataset, hid_t type, hsize_t at,
                   std::vector<Value> const& values, std::filesystem::path const& path) {
  auto const extents = extents_of<Value>(values.size());
  Extents from(extents.size(), 0);
  from[0] = at;
  append_block(dataset.get(), type, from, extents, values.data(), path);
}

// The rows from `begin` to `end`.
template <class Value>
std::vector<Value> read_column(DatasetHandle const& dataset, hid_t type, std::int64_t begin,
                               std::int64_t end, std::filesystem::path const& path) {
  std::vector<Value> values(static_cast<std::size_t>(end - begin));
  if (values.empty()) return values;
  auto const extents = extents_of<Value>(values.size());
  Extents from(extents.size(), 0);
  from[0] = static_cast<hsize_t>(begin);
  read_block(dataset.get(), type, from, extents, values.data(), path);
  return values;
}

}  // namespace

ScalarSeries ScalarSeries::create(hid_t group, std::filesystem::path const& path,
                                  std::int64_t cell_sites) {
  ScalarSeries series;
  series.time_ = create_column<double>(group, "time", H5T_IEEE_F64LE, path);
  series.step_ = create_column<std::int64_t>(group, "step", H5T_STD_I64LE, path);
  for_each_scalar([&]<class Value>(char const* name, Value Scalars::*) {
    series.scalars_.push_back(create_column<Value>(group, name, H5T_IEEE_F64LE, path));
  });
  series.checksum_ = create_column<std::uint64_t>(group, "checksum", H5T_STD_U64LE, path);
  series.cell_sites_ = cell_sites;
  if (cell_sites == 1) return series;
  auto const sites = static_cast<hsize_t>(cell_sites);
  std::array<hsize_t, 3> const of_sites{std::max<hsize_t>(1, samples_per_chunk / sites), sites, 3};
  series.sublattices_ = create_growing_dataset(group, sublattices_name, H5T_IEEE_F64LE, of_sites,
                                               PropertyHandle(), path);
  return series;
}

ScalarSeries ScalarSeries::open(hid_t group, std::filesystem::path const& path,
                                std::int64_t cell_sites) {
  ScalarSeries series;
  series.time_ = open_dataset(group, "time", 1, path);
  series.step_ = open_dataset(group, "step", 1, path);
  for_each_scalar([&]<class Value>(char const* name, Value Scalars::*) {
    auto const expected = extents_of<Value>(0);
    auto const& dataset =
        series.scalars_.emplace_back(open_dataset(group, name, expected.size(), path));
    if (expected.size() > 1 && dataset_extents(dataset.get(), path)[1] != expected[1])
      throw_failure(path, std::string("cannot read dataset ") + name,
                    "its second extent is not " + std::to_string(expected[1]));
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
  auto const checksums = column(samples, [&](auto const& s) {
    return std::uint64_t{row_checksum(s, sublattices)} << 32U | spins;
  });
  hsize_t const count = samples.size();
  auto const append = [&](DatasetHandle const& dataset, hid_t type, auto const& member) {
    append_column(dataset, type, size_, column(samples, member), path);
  };
  append(time_, H5T_NATIVE_DOUBLE, [](auto const& s) { return s.time; });
  append(step_, H5T_NATIVE_INT64, [](auto const& s) { return s.step; });
  auto dataset = scalars_.begin();
  for_each_scalar([&](char const*, auto member) {
    append(*dataset++, H5T_NATIVE_DOUBLE, [&](auto const& s) { return s.scalars.*member; });
  });
  if (sublattices_.get() >= 0)
    append_block(sublattices_.get(), H5T_NATIVE_DOUBLE, {size_, 0, 0},
                 {count, static_cast<hsize_t>(cell_sites_), 3}, sublattices.data(), path);
  append_column(checksum_, H5T_NATIVE_UINT64, size_, checksums, path);
  size_ += count;
}

std::int64_t ScalarSeries::size(std::filesystem::path const& path) const {
  auto shortest = dataset_extents(time_.get(), path)[0];
  auto const shorten = [&](DatasetHandle const& dataset) {
    if (dataset.get() >= 0) shortest = std::min(shortest, dataset_extents(dataset.get(), path)[0]);
  };
  for (auto const* dataset : {&step_, &checksum_, &sublattices_}) shorten(*dataset);
  for (auto const& dataset : scalars_) shorten(dataset);
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
  auto const times = read_column<double>(time_, H5T_NATIVE_DOUBLE, begin, end, path);
  auto const steps = read_column<std::int64_t>(step_, H5T_NATIVE_INT64, begin, end, path);
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < times.size(); ++i) samples.push_back({steps[i], times[i], {}});
  auto dataset = scalars_.begin();
  for_each_scalar([&]<class Value>(char const*, Value Scalars::*member) {
    auto const values = read_column<Value>(*dataset++, H5T_NATIVE_DOUBLE, begin, end, path);
    for (std::size_t i = 0; i < values.size(); ++i) samples[i].scalars.*member = values[i];
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
  return read_column<std::uint64_t>(checksum_, H5T_NATIVE_UINT64, begin, end, path);
}

}  // namespace cayspin::inline v0_1::io
