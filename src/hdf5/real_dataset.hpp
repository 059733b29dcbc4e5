// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "dataset.hpp"
#include "handle.hpp"

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// The types of a dataset that are accepted. `numbers` adds to float and double integers of up to
/// 64 bits, and the booleans of h5py, which are 0 and 1.
enum class Accepted { reals, numbers };

/// A dataset of numbers in any HDF5 file, read as double. Its members throw std::runtime_error with
/// a one-line message that starts with the file's path.
class RealDataset {
 public:
  RealDataset(std::filesystem::path path, std::string name, Accepted accepted = Accepted::reals);

  hid_t file() const { return file_.get(); }
  Extents const& extents() const { return extents_; }
  /// Returns the extents of a chunk; 1 along each axis if the dataset is not chunked.
  Extents chunk() const;
  /// Returns the machine epsilon of the stored type; of double for integers.
  double epsilon() const { return epsilon_; }

  /// Reads all of the dataset, or the block of these extents that starts at `begin`; the last index
  /// varies fastest. Integers that double cannot represent are refused.
  std::vector<double> read() const;
  std::vector<double> read(Extents const& begin, Extents const& extents) const;

  [[noreturn]] void refuse(std::string const& reason) const;
  [[noreturn]] void refuse_extents(std::string const& accepted) const;

 private:
  template <class Integer>
  std::vector<double> read_long(hid_t memory_type, Extents const& begin,
                                Extents const& extents) const;

  std::filesystem::path path_;
  std::string name_;
  FileHandle file_;
  DatasetHandle dataset_;
  Extents extents_;
  double epsilon_ = std::numeric_limits<double>::epsilon();
  bool is_long_ = false, is_signed_ = true;  ///< integers of more than 32 bits
};

}  // namespace cayspin::inline v0_2::io
