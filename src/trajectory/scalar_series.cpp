// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scalar_series.hpp"

#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"

#include <algorithm>
#include <array>

namespace cayspin::io {
namespace {

constexpr hsize_t samples_per_chunk = 512;

DatasetHandle create_column(hid_t group, char const* name, hid_t type,
                            std::filesystem::path const& path) {
  std::array<hsize_t, 1> const chunk{samples_per_chunk};
  return create_growing_dataset(group, name, type, chunk, PropertyHandle(), path);
}

template <class Member>
auto column(std::vector<Sample> const& samples, Member const& member) {
  std::vector<std::decay_t<decltype(member(samples.front()))>> values;
  values.reserve(samples.size());
  for (auto const& sample : samples) values.push_back(member(sample));
  return values;
}

// The rows from `begin` to `end`; `inner` are the extents of a row.
template <class Value>
std::vector<Value> read_column(hid_t dataset, hid_t type, std::int64_t begin, std::int64_t end,
                               Extents const& inner, std::filesystem::path const& path) {
  std::vector<Value> values(static_cast<std::size_t>(end - begin));
  if (values.empty()) return values;
  Extents extents{values.size()};
  extents.insert(extents.end(), inner.begin(), inner.end());
  Extents from(extents.size(), 0);
  from[0] = static_cast<hsize_t>(begin);
  read_block(dataset, type, from, extents, values.data(), path);
  return values;
}

}  // namespace

ScalarSeries ScalarSeries::create(hid_t group, std::filesystem::path const& path) {
  ScalarSeries series;
  series.time_ = create_column(group, "time", H5T_IEEE_F64LE, path);
  series.step_ = create_column(group, "step", H5T_STD_I64LE, path);
  series.energy_ = create_column(group, "energy", H5T_IEEE_F64LE, path);
  series.norm_defect_ = create_column(group, "norm_defect", H5T_IEEE_F64LE, path);
  std::array<hsize_t, 2> const chunk{samples_per_chunk, 3};
  series.magnetization_ =
      create_growing_dataset(group, "magnetization", H5T_IEEE_F64LE, chunk, PropertyHandle(), path);
  return series;
}

ScalarSeries ScalarSeries::open(hid_t group, std::filesystem::path const& path) {
  ScalarSeries series;
  series.time_ = open_dataset(group, "time", 1, path);
  series.step_ = open_dataset(group, "step", 1, path);
  series.energy_ = open_dataset(group, "energy", 1, path);
  series.norm_defect_ = open_dataset(group, "norm_defect", 1, path);
  series.magnetization_ = open_dataset(group, "magnetization", 2, path);
  if (dataset_extents(series.magnetization_.get(), path)[1] != 3)
    throw_failure(path, "cannot read dataset magnetization", "its second extent is not 3");
  return series;
}

void ScalarSeries::append(std::vector<Sample> const& samples, std::filesystem::path const& path) {
  if (samples.empty()) return;
  auto const times = column(samples, [](auto const& s) { return s.time; });
  auto const steps = column(samples, [](auto const& s) { return s.step; });
  auto const energies = column(samples, [](auto const& s) { return s.scalars.energy; });
  auto const defects = column(samples, [](auto const& s) { return s.scalars.norm_defect; });
  auto const means = column(samples, [](auto const& s) { return s.scalars.magnetization; });
  hsize_t const count = samples.size();
  append_block(time_.get(), H5T_NATIVE_DOUBLE, {size_}, {count}, times.data(), path);
  append_block(step_.get(), H5T_NATIVE_INT64, {size_}, {count}, steps.data(), path);
  append_block(energy_.get(), H5T_NATIVE_DOUBLE, {size_}, {count}, energies.data(), path);
  append_block(norm_defect_.get(), H5T_NATIVE_DOUBLE, {size_}, {count}, defects.data(), path);
  append_block(magnetization_.get(), H5T_NATIVE_DOUBLE, {size_, 0}, {count, 3}, means.data(), path);
  size_ += count;
}

std::int64_t ScalarSeries::size(std::filesystem::path const& path) const {
  auto shortest = dataset_extents(time_.get(), path)[0];
  for (auto const* dataset : {&step_, &energy_, &norm_defect_, &magnetization_})
    shortest = std::min(shortest, dataset_extents(dataset->get(), path)[0]);
  return static_cast<std::int64_t>(shortest);
}

std::vector<Sample> ScalarSeries::read(std::int64_t begin, std::int64_t end,
                                       std::filesystem::path const& path) const {
  auto const read = [&]<class Value>(DatasetHandle const& dataset, hid_t type, Extents const& inner,
                                     Value) {
    return read_column<Value>(dataset.get(), type, begin, end, inner, path);
  };
  auto const times = read(time_, H5T_NATIVE_DOUBLE, {}, double());
  auto const steps = read(step_, H5T_NATIVE_INT64, {}, std::int64_t());
  auto const energies = read(energy_, H5T_NATIVE_DOUBLE, {}, double());
  auto const defects = read(norm_defect_, H5T_NATIVE_DOUBLE, {}, double());
  auto const means = read(magnetization_, H5T_NATIVE_DOUBLE, {3}, std::array<double, 3>());
  std::vector<Sample> samples;
  for (std::size_t i = 0; i < times.size(); ++i)
    samples.push_back({steps[i], times[i], {energies[i], defects[i], means[i]}});
  return samples;
}

}  // namespace cayspin::io
