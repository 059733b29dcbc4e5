// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "scalar_series.hpp"

#include "checksum.hpp"
#include "column.hpp"
#include "hdf5/attribute.hpp"
#include "hdf5/error.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

constexpr hsize_t samples_per_chunk = 512;
constexpr char const *sublattices_name = "sublattice_magnetization",
                     *region_means_name = "region_magnetization",
                     *region_energies_name = "region_energy", *term_energies_name = "term_energy",
                     *shift_name = "shift", *stage_name = "stage", *terms_name = "terms";

constexpr hsize_t most_more = 1 << 24;  // most numbers per sample in a dataset

Extents extents_of(hsize_t count, Extents const& of_sample) {
  Extents extents{count};
  extents.insert(extents.end(), of_sample.begin(), of_sample.end());
  return extents;
}

Extents begin_of(hsize_t first, Extents const& of_sample) {
  return extents_of(first, Extents(of_sample.size(), 0));
}

// Calls use(name, member) for each dataset with one or three numbers per sample, in the order of
// the file.
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
                                  std::int64_t cell_sites, MoreScalars const& more) {
  ScalarSeries series;
  auto const create = [&](char const* name, hid_t type, Extents const& chunk) {
    return create_growing_dataset(group, name, type, chunk, PropertyHandle(), path);
  };
  for_each_column([&](char const* name, auto const& member) {
    using Stored = Column<MemberValue<Sample, decltype(member)>>;
    series.columns_.push_back(create(name, Stored::type(), Stored::extents(samples_per_chunk)));
  });
  series.checksum_ = create("checksum", H5T_STD_U64LE, {samples_per_chunk});
  auto const add = [&](char const* name, Extents const& of_sample, hid_t type = H5T_IEEE_F64LE) {
    Extents chunk{std::max<hsize_t>(1, samples_per_chunk / elements(of_sample))};
    chunk.insert(chunk.end(), of_sample.begin(), of_sample.end());
    series.more_.push_back({name, of_sample, create(name, type, chunk)});
  };
  auto const regions = static_cast<hsize_t>(more.regions);
  if (cell_sites > 1) add(sublattices_name, {static_cast<hsize_t>(cell_sites), 3});
  if (regions > 0) add(region_means_name, {regions, 3});
  if (regions > 0) add(region_energies_name, {regions});
  if (!more.terms.empty()) {
    add(term_energies_name, {more.terms.size()});
    write_names(series.more_.back().dataset.get(), terms_name, more.terms, path);
  }
  if (more.shift) add(shift_name, {}, H5T_STD_I64LE);
  if (more.stage) add(stage_name, {}, H5T_STD_I64LE);
  return series;
}

ScalarSeries ScalarSeries::open(hid_t group, std::filesystem::path const& path,
                                std::int64_t cell_sites) {
  ScalarSeries series;
  auto const has = [&](char const* name) {
    return check(H5Lexists(group, name, H5P_DEFAULT), path,
                 std::string("cannot read dataset ") + name) > 0;
  };
  for_each_column([&](char const* name, auto const& member) {
    using Stored = Column<MemberValue<Sample, decltype(member)>>;
    auto dataset = open_dataset(group, name, Stored::is_triple ? 2 : 1, path);
    if (Stored::is_triple && dataset_extents(dataset.get(), path)[1] != 3)
      throw_failure(path, std::string("cannot read dataset ") + name, "its second extent is not 3");
    series.columns_.push_back(std::move(dataset));
  });
  if (has("checksum")) series.checksum_ = open_dataset(group, "checksum", 1, path);
  auto const add = [&](char const* name, std::size_t rank) -> Extents {
    auto dataset = open_dataset(group, name, rank, path);
    auto extents = dataset_extents(dataset.get(), path);
    extents.erase(extents.begin());
    auto const cannot_be = [](hsize_t extent) { return extent == 0 || extent > most_more; };
    if (std::ranges::any_of(extents, cannot_be) || elements(extents) > most_more)
      throw_failure(path, std::string("cannot read dataset ") + name,
                    "its inner extents are out of range");
    series.more_.push_back({name, extents, std::move(dataset)});
    return extents;
  };
  Extents const sublattices{static_cast<hsize_t>(cell_sites), 3};
  if (cell_sites > 1 && add(sublattices_name, 3) != sublattices)
    throw_failure(path, std::string("cannot read dataset ") + sublattices_name,
                  "its inner extents are not (" + std::to_string(cell_sites) + ", 3)");
  if (has(region_means_name)) {
    auto const means = add(region_means_name, 3), energies = add(region_energies_name, 2);
    if (means != Extents{energies[0], 3})
      throw_failure(path, std::string("cannot read dataset ") + region_means_name,
                    "it is not of the regions of " + std::string(region_energies_name));
  }
  if (has(term_energies_name)) add(term_energies_name, 2);
  if (has(shift_name)) add(shift_name, 1);
  if (has(stage_name)) add(stage_name, 1);
  return series;
}

// The datasets do not use the filter fletcher32: its sum would cover a whole chunk of 512 samples,
// which is written in pieces.
void ScalarSeries::append(std::vector<Sample> const& samples, std::filesystem::path const& path,
                          std::uint32_t spins, std::vector<double> const& more) {
  if (samples.empty()) return;
  hsize_t const count = samples.size();
  auto const width = more_count();
  std::vector<std::uint64_t> checksums(count);
  for (std::size_t i = 0; i < count; ++i)
    checksums[i] =
        std::uint64_t{row_checksum(samples[i], std::span(more).subspan(i * width, width))} << 32U |
        spins;
  auto dataset = columns_.begin();
  for_each_column([&](char const*, auto const& member) {
    using Stored = Column<MemberValue<Sample, decltype(member)>>;
    append_block((dataset++)->get(), Stored::memory_type(), Stored::begin(size_),
                 Stored::extents(count), values_of(samples, member).data(), path);
  });
  std::size_t first = 0;
  for (auto const& [name, of_sample, dataset] : more_) {
    auto const numbers = elements(of_sample);
    std::vector<double> values;
    values.reserve(count * numbers);
    for (std::size_t i = 0; i < count; ++i) {
      auto const from = more.begin() + static_cast<std::ptrdiff_t>(i * width + first);
      values.insert(values.end(), from, from + static_cast<std::ptrdiff_t>(numbers));
    }
    append_block(dataset.get(), H5T_NATIVE_DOUBLE, begin_of(size_, of_sample),
                 extents_of(count, of_sample), values.data(), path);
    first += numbers;
  }
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
  for (auto const& column : more_) count(column.dataset);
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
  auto const more = read_more(begin, end, path);
  auto const width = more_count();
  for (std::size_t i = 0; i < samples.size(); ++i)
    if (checksums[i] >> 32U != row_checksum(samples[i], std::span(more).subspan(i * width, width)))
      throw_failure(path, "cannot read the trajectory",
                    "sample " + std::to_string(begin + static_cast<std::int64_t>(i)) +
                        " is damaged: its checksum differs");
  return samples;
}

std::vector<double> ScalarSeries::read_more(std::int64_t begin, std::int64_t end,
                                            std::filesystem::path const& path) const {
  auto const count = static_cast<std::size_t>(end - begin);
  auto const width = more_count();
  std::vector<double> more(count * width);
  if (more.empty()) return more;
  std::size_t first = 0;
  for (auto const& [name, of_sample, dataset] : more_) {
    auto const numbers = elements(of_sample);
    std::vector<double> values(count * numbers);
    read_block(dataset.get(), H5T_NATIVE_DOUBLE, begin_of(static_cast<hsize_t>(begin), of_sample),
               extents_of(count, of_sample), values.data(), path);
    for (std::size_t i = 0; i < values.size(); ++i)
      more[i / numbers * width + first + i % numbers] = values[i];
    first += numbers;
  }
  return more;
}

std::size_t ScalarSeries::more_count() const {
  std::size_t count = 0;
  for (auto const& column : more_) count += elements(column.of_sample);
  return count;
}

MoreScalars ScalarSeries::more_scalars(std::filesystem::path const& path) const {
  MoreScalars more;
  for (auto const& [name, of_sample, dataset] : more_) {
    if (name == region_energies_name) more.regions = static_cast<std::int64_t>(of_sample[0]);
    if (name == term_energies_name) {
      more.terms = read_names(dataset.get(), terms_name, path);
      if (more.terms.size() != of_sample[0])
        throw_failure(path, std::string("cannot read dataset ") + name,
                      "it does not have a name for each term");
    }
    if (name == shift_name) more.shift = true;
    if (name == stage_name) more.stage = true;
  }
  return more;
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

}  // namespace cayspin::inline v0_2::io
