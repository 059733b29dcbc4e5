// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "replica_series.hpp"

#include "ensemble_format.hpp"
#include "hdf5/error.hpp"

#include <algorithm>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

constexpr hsize_t numbers_per_chunk = 4096;

// Returns how many samples of `numbers` numbers are in a chunk.
hsize_t samples_in_chunk(hsize_t numbers) {
  return std::max<hsize_t>(1, numbers_per_chunk / numbers);
}

}  // namespace

PropertyHandle filled_with(double missing, std::filesystem::path const& path) {
  PropertyHandle properties(H5Pcreate(H5P_DATASET_CREATE));
  check(H5Pset_fill_value(properties.get(), H5T_NATIVE_DOUBLE, &missing), path,
        "cannot create a dataset");
  return properties;
}

ReplicaSeries ReplicaSeries::create(hid_t group, std::int64_t replicas,
                                    std::filesystem::path const& path) {
  ReplicaSeries series;
  auto const count = series.replicas_ = static_cast<hsize_t>(replicas);
  auto const samples = samples_in_chunk(count);
  auto const make = [&](char const* name, Extents const& chunk) {
    return create_growing_dataset(group, name, H5T_IEEE_F64LE, chunk,
                                  filled_with(missing_number, path), path);
  };
  series.time_ = make("time", {numbers_per_chunk});
  series.step_ = create_growing_dataset(group, "step", H5T_STD_I64LE, Extents{numbers_per_chunk},
                                        filled_with(missing_step, path), path);
  series.energy_ = make("energy", {samples, count});
  series.norm_defect_ = make("norm_defect", {samples, count});
  series.magnetization_ = make("magnetization", {samples, count, 3});
  return series;
}

ReplicaSeries ReplicaSeries::create_of_frames(hid_t group, std::int64_t replicas,
                                              std::int64_t cell_sites,
                                              std::filesystem::path const& path) {
  auto series = create(group, replicas, path);
  auto const count = series.replicas_;
  auto const sites = series.cell_sites_ = static_cast<hsize_t>(cell_sites);
  if (sites > 1)
    series.sublattices_ =
        create_growing_dataset(group, sublattices_of_replicas, H5T_IEEE_F64LE,
                               Extents{samples_in_chunk(count * sites), count, sites, 3},
                               filled_with(missing_number, path), path);
  // No checksum is 0, which is read where none reached the disk.
  series.checksum_ =
      create_growing_dataset(group, checksum_of_replicas, H5T_STD_U64LE,
                             Extents{samples_in_chunk(count), count}, PropertyHandle(), path);
  return series;
}

void ReplicaSeries::append(std::int64_t step, double time, std::vector<Scalars> const& scalars,
                           std::filesystem::path const& path) {
  std::vector<double> energies, defects, means;
  for (auto const& one : scalars) {
    energies.push_back(one.energy);
    defects.push_back(one.norm_defect);
    means.insert(means.end(), one.magnetization.begin(), one.magnetization.end());
  }
  append_block(time_.get(), H5T_NATIVE_DOUBLE, {size_}, {1}, &time, path);
  append_block(step_.get(), H5T_NATIVE_INT64, {size_}, {1}, &step, path);
  append_block(magnetization_.get(), H5T_NATIVE_DOUBLE, {size_, 0, 0}, {1, replicas_, 3},
               means.data(), path);
  append_block(norm_defect_.get(), H5T_NATIVE_DOUBLE, {size_, 0}, {1, replicas_}, defects.data(),
               path);
  append_block(energy_.get(), H5T_NATIVE_DOUBLE, {size_, 0}, {1, replicas_}, energies.data(), path);
  ++size_;
}

void ReplicaSeries::append(std::int64_t step, double time, std::vector<Scalars> const& scalars,
                           ReplicaFrame const& frame, std::filesystem::path const& path) {
  if (!frame.sublattices.empty())
    append_block(sublattices_.get(), H5T_NATIVE_DOUBLE, {size_, 0, 0, 0},
                 {1, replicas_, cell_sites_, 3}, frame.sublattices.data(), path);
  append_block(checksum_.get(), H5T_NATIVE_UINT64, {size_, 0}, {1, replicas_},
               frame.checksums.data(), path);
  append(step, time, scalars, path);
}

}  // namespace cayspin::inline v0_2::io
