// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <gtest/gtest.h>
#include <hdf5.h>

#include <cstddef>
#include <filesystem>
#include <vector>

namespace cayspin::test {

/// Tensors of inertia as h5py writes them: in the oldest format, without checksums.
inline void write_inertia(std::filesystem::path const& path, std::size_t bodies) {
  hid_t const file = H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  hsize_t const extents[3] = {bodies, 3, 3};
  hid_t const space = H5Screate_simple(3, extents, nullptr);
  hid_t const dataset =
      H5Dcreate2(file, "inertia", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
  std::vector<double> values(bodies * 9, 0.0);
  for (std::size_t body = 0; body < bodies; ++body)
    for (std::size_t axis = 0; axis < 3; ++axis)
      values[9 * body + 4 * axis] = 1 + 0.01 * static_cast<double>(body + axis);
  ASSERT_GE(H5Dwrite(dataset, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), 0);
  H5Dclose(dataset);
  H5Sclose(space);
  H5Fclose(file);
}

}  // namespace cayspin::test
