// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/handle.hpp"

#include <cayspin/io/trajectory.hpp>

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::io {

struct Sample {
  std::int64_t step;
  double time;
  Scalars scalars;
};

/// The datasets time, step, energy, norm_defect and magnetization of one group.
class ScalarSeries {
 public:
  static ScalarSeries create(hid_t group, std::filesystem::path const& path);
  static ScalarSeries open(hid_t group, std::filesystem::path const& path);

  void append(std::vector<Sample> const& samples, std::filesystem::path const& path);

  /// Samples that are whole: the shortest of the datasets counts.
  std::int64_t size(std::filesystem::path const& path) const;
  /// Of these samples, the first `count`, or those from `begin` to `end`.
  std::vector<Sample> read(std::int64_t count, std::filesystem::path const& path) const {
    return read(0, count, path);
  }
  std::vector<Sample> read(std::int64_t begin, std::int64_t end,
                           std::filesystem::path const& path) const;

 private:
  DatasetHandle time_, step_, energy_, norm_defect_, magnetization_;
  hsize_t size_ = 0;
};

}  // namespace cayspin::io
