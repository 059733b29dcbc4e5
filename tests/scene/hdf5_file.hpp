// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <stdexcept>
#include <vector>

namespace cayspin::inline v0_2::io::test {

/// Writes one dataset into a new file; `stored` is the type in the file.
inline void write_dataset(std::filesystem::path const& path, char const* name,
                          std::vector<hsize_t> const& extents, std::vector<double> const& values,
                          hid_t stored = H5T_NATIVE_DOUBLE) {
  hid_t const file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  hid_t const space = H5Screate_simple(static_cast<int>(extents.size()), extents.data(), nullptr);
  hid_t const dataset =
      H5Dcreate2(file, name, stored, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  auto const status =
      H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data());
  H5Dclose(dataset);
  H5Sclose(space);
  H5Fclose(file);
  if (status < 0) throw std::runtime_error("cannot write " + path.string());
}

}  // namespace cayspin::inline v0_2::io::test
