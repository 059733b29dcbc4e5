// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "dataset.hpp"

#include "error.hpp"

#include <algorithm>
#include <functional>
#include <numeric>
#include <string>

namespace cayspin::inline v0_2::io {
namespace {

std::string dataset_name(hid_t dataset) {
  std::string name(256, '\0');
  auto const length = H5Iget_name(dataset, name.data(), name.size());
  name.resize(std::clamp<ssize_t>(length, 0, 255));
  return name;
}

// Selects the block in the file and returns the pair of dataspaces (memory, file).
std::pair<DataspaceHandle, DataspaceHandle> select_block(hid_t dataset, Extents const& begin,
                                                         Extents const& extents,
                                                         std::filesystem::path const& path,
                                                         std::string const& action) {
  auto const rank = static_cast<int>(extents.size());
  DataspaceHandle memory(check(H5Screate_simple(rank, extents.data(), nullptr), path, action));
  DataspaceHandle file(check(H5Dget_space(dataset), path, action));
  check(H5Sselect_hyperslab(file.get(), H5S_SELECT_SET, begin.data(), nullptr, extents.data(),
                            nullptr),
        path, action);
  return {std::move(memory), std::move(file)};
}

}  // namespace

hsize_t elements(Extents const& extents) {
  return std::accumulate(extents.begin(), extents.end(), hsize_t{1}, std::multiplies<>{});
}

DatasetHandle create_growing_dataset(hid_t group, char const* name, hid_t type,
                                     std::span<hsize_t const> chunk, PropertyHandle properties,
                                     std::filesystem::path const& path,
                                     std::span<hsize_t const> inner) {
  auto const action = std::string("cannot create dataset ") + name;
  if (properties.get() < 0) properties = PropertyHandle(H5Pcreate(H5P_DATASET_CREATE));
  Extents extents(chunk.begin(), chunk.end());
  std::copy(inner.begin(), inner.end(), extents.begin() + 1);
  extents[0] = 0;
  auto largest = extents;
  largest[0] = H5S_UNLIMITED;
  auto const rank = static_cast<int>(chunk.size());
  check(H5Pset_chunk(properties.get(), rank, chunk.data()), path, action);
  DataspaceHandle const space(
      check(H5Screate_simple(rank, extents.data(), largest.data()), path, action));
  // Without a chunk cache, appending writes only the new data.
  PropertyHandle const access(H5Pcreate(H5P_DATASET_ACCESS));
  check(H5Pset_chunk_cache(access.get(), 1, 0, 1), path, action);
  return DatasetHandle(
      check(H5Dcreate2(group, name, type, space.get(), H5P_DEFAULT, properties.get(), access.get()),
            path, action));
}

DatasetHandle create_dataset(hid_t group, char const* name, hid_t type, Extents const& extents,
                             std::filesystem::path const& path, hid_t properties) {
  auto const action = std::string("cannot write dataset ") + name;
  auto const rank = static_cast<int>(extents.size());
  DataspaceHandle const space(check(H5Screate_simple(rank, extents.data(), nullptr), path, action));
  return DatasetHandle(
      check(H5Dcreate2(group, name, type, space.get(), H5P_DEFAULT, properties, H5P_DEFAULT), path,
            action));
}

void write_dataset(hid_t group, char const* name, hid_t type, hid_t memory_type,
                   Extents const& extents, void const* values, std::filesystem::path const& path,
                   hid_t properties) {
  auto const dataset = create_dataset(group, name, type, extents, path, properties);
  check(H5Dwrite(dataset.get(), memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values), path,
        std::string("cannot write dataset ") + name);
}

DatasetHandle open_dataset(hid_t group, char const* name, std::size_t rank,
                           std::filesystem::path const& path) {
  auto dataset = open_dataset(group, name, path);
  if (dataset_extents(dataset.get(), path).size() != rank)
    throw_failure(path, std::string("cannot read dataset ") + name,
                  "its rank is not " + std::to_string(rank));
  return dataset;
}

DatasetHandle open_dataset(hid_t group, char const* name, std::filesystem::path const& path) {
  auto const exists = H5Lexists(group, name, H5P_DEFAULT);
  auto const action = std::string("cannot read dataset ") + name;
  if (exists == 0) throw_failure(path, action, "it is not there");
  check(exists, path, action);
  return DatasetHandle(check(H5Dopen2(group, name, H5P_DEFAULT), path, action));
}

Extents dataset_extents(hid_t dataset, std::filesystem::path const& path) {
  auto const action = "cannot read the extents of " + dataset_name(dataset);
  DataspaceHandle const space(check(H5Dget_space(dataset), path, action));
  Extents extents(check(H5Sget_simple_extent_ndims(space.get()), path, action));
  check(H5Sget_simple_extent_dims(space.get(), extents.data(), nullptr), path, action);
  return extents;
}

void grow(hid_t dataset, hsize_t first_extent, std::filesystem::path const& path) {
  auto grown = dataset_extents(dataset, path);
  grown[0] = first_extent;
  check(H5Dset_extent(dataset, grown.data()), path, "cannot write " + dataset_name(dataset));
}

void write_block(hid_t dataset, hid_t memory_type, Extents const& begin, Extents const& extents,
                 void const* values, std::filesystem::path const& path) {
  auto const action = "cannot write " + dataset_name(dataset);
  auto const [memory, file] = select_block(dataset, begin, extents, path, action);
  check(H5Dwrite(dataset, memory_type, memory.get(), file.get(), H5P_DEFAULT, values), path,
        action);
}

void append_block(hid_t dataset, hid_t memory_type, Extents const& begin, Extents const& extents,
                  void const* values, std::filesystem::path const& path) {
  grow(dataset, begin[0] + extents[0], path);
  write_block(dataset, memory_type, begin, extents, values, path);
}

void write_raw_chunk(hid_t dataset, Extents const& begin, void const* stored, std::size_t bytes,
                     std::filesystem::path const& path) {
  check(H5Dwrite_chunk(dataset, H5P_DEFAULT, 0, begin.data(), bytes, stored), path,
        "cannot write " + dataset_name(dataset));
}

void read_block(hid_t dataset, hid_t memory_type, Extents const& begin, Extents const& extents,
                void* values, std::filesystem::path const& path) {
  auto const action = "cannot read " + dataset_name(dataset);
  auto const [memory, file] = select_block(dataset, begin, extents, path, action);
  check(H5Dread(dataset, memory_type, memory.get(), file.get(), H5P_DEFAULT, values), path, action);
}

}  // namespace cayspin::inline v0_2::io
