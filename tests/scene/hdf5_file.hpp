// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

namespace cayspin::inline v0_2::io::test {

/// Writes one dataset into a new file; `stored` is the type in the file, and `memory_type` that of
/// the values.
template <class Value>
void write_dataset_as(std::filesystem::path const& path, char const* name,
                      std::vector<hsize_t> const& extents, std::vector<Value> const& values,
                      hid_t memory_type, hid_t stored) {
  hid_t const file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  hid_t const space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
  hid_t const dataset =
      H5Dcreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  auto const status = H5Dwrite(dataset, memory_type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(dataset);
  H5Sclose(space);
  H5Fclose(file);
  if (status < 0) throw std::runtime_error("cannot write " + path.string());
}

inline void write_dataset(std::filesystem::path const& path, char const* name,
                          std::vector<hsize_t> const& extents, std::vector<double> const& values,
                          hid_t stored = H5T_NATIVE_DOUBLE) {
  write_dataset_as(path, name, extents, values, H5T_NATIVE_DOUBLE, stored);
}

}  // namespace cayspin::inline v0_2::io::test
