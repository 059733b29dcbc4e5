// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "positions.hpp"

#include "format.hpp"
#include "hdf5/dataset.hpp"
#include "hdf5/error.hpp"

#include <string>

namespace cayspin::inline v0_2::io {

void write_positions(hid_t file, TrajectoryHeader const& header,
                     std::vector<double> const& positions, std::filesystem::path const& path) {
  auto block = header.shape;
  block[2] /= header.cell_sites;
  auto const of_chunk = frame_chunk(block, sizeof(double));
  Extents chunk(of_chunk.begin() + 1, of_chunk.end()), extents{3};
  for (auto const extent : block) extents.insert(extents.begin(), static_cast<hsize_t>(extent));
  if (header.cell_sites > 1) {
    chunk.insert(chunk.begin(), 1);
    extents.insert(extents.begin(), static_cast<hsize_t>(header.cell_sites));
  }
  std::string const action = "cannot write dataset positions";
  PropertyHandle const properties(H5Pcreate(H5P_DATASET_CREATE));
  check(H5Pset_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), path, action);
  check(H5Pset_fletcher32(properties.get()), path, action);
  write_dataset(file, "positions", H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, extents, positions.data(),
                path, properties.get());
}

}  // namespace cayspin::inline v0_2::io
