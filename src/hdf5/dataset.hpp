// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "handle.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <vector>

namespace cayspin::inline v0_2::io {

using Extents = std::vector<hsize_t>;

/// Returns the number of elements of a dataset of these extents.
hsize_t elements(Extents const& extents);

/// Creates a chunked dataset whose first extent is 0 and unlimited. Its other extents are `inner`,
/// or those of the chunk when `inner` is empty. `properties` may add filters.
DatasetHandle create_growing_dataset(hid_t group, char const* name, hid_t type,
                                     std::span<hsize_t const> chunk, PropertyHandle properties,
                                     std::filesystem::path const& path,
                                     std::span<hsize_t const> inner = {});

/// Creates a dataset of these extents. `properties`: a property list of class H5P_DATASET_CREATE.
DatasetHandle create_dataset(hid_t group, char const* name, hid_t type, Extents const& extents,
                             std::filesystem::path const& path, hid_t properties = H5P_DEFAULT);

/// Creates a dataset and writes all its values, which are of `memory_type`.
void write_dataset(hid_t group, char const* name, hid_t type, hid_t memory_type,
                   Extents const& extents, void const* values, std::filesystem::path const& path,
                   hid_t properties = H5P_DEFAULT);

DatasetHandle open_dataset(hid_t group, char const* name, std::filesystem::path const& path);

/// Opens a dataset; throws unless it has `rank` extents.
DatasetHandle open_dataset(hid_t group, char const* name, std::size_t rank,
                           std::filesystem::path const& path);

Extents dataset_extents(hid_t dataset, std::filesystem::path const& path);

/// Writes a block; `begin` and `extents` have the dataset's rank.
void write_block(hid_t dataset, hid_t memory_type, Extents const& begin, Extents const& extents,
                 void const* values, std::filesystem::path const& path);

/// Grows a dataset along its first extent to begin[0] + extents[0], and writes the block.
void append_block(hid_t dataset, hid_t memory_type, Extents const& begin, Extents const& extents,
                  void const* values, std::filesystem::path const& path);

/// Sets the first extent of a dataset to `first_extent`, without writing.
void grow(hid_t dataset, hsize_t first_extent, std::filesystem::path const& path);

/// Writes the chunk that starts at `begin`. `stored`: its bytes as in the file, after all filters.
void write_raw_chunk(hid_t dataset, Extents const& begin, void const* stored, std::size_t bytes,
                     std::filesystem::path const& path);

/// Reads a block; `begin` and `extents` have the dataset's rank.
void read_block(hid_t dataset, hid_t memory_type, Extents const& begin, Extents const& extents,
                void* values, std::filesystem::path const& path);

}  // namespace cayspin::inline v0_2::io
