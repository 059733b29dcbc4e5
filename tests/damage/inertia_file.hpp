// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/dataset.hpp"

#include <cstddef>
#include <filesystem>
#include <vector>

namespace cayspin::test {

/// Writes inertia tensors as h5py does: in the oldest format, without checksums.
inline void write_inertia(std::filesystem::path const& path, std::size_t bodies) {
  std::vector<double> values(bodies * 9, 0.0);
  for (std::size_t body = 0; body < bodies; ++body)
    for (std::size_t axis = 0; axis < 3; ++axis)
      values[9 * body + 4 * axis] = 1 + 0.01 * static_cast<double>(body + axis);
  io::FileHandle const file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  io::write_dataset(file.get(), "inertia", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, {bodies, 3, 3},
                    values.data(), path);
}

}  // namespace cayspin::test
