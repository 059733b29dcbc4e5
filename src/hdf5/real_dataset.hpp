// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "dataset.hpp"
#include "handle.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::inline v0_2::io {

/// A dataset of type float or double in any HDF5 file, read as double. Its members throw
/// std::runtime_error with a one-line message that starts with the file's path.
class RealDataset {
 public:
  RealDataset(std::filesystem::path path, std::string name);

  hid_t file() const { return file_.get(); }
  Extents const& extents() const { return extents_; }
  /// Returns the extents of a chunk; 1 along each axis if the dataset is not chunked.
  Extents chunk() const;
  /// Returns the machine epsilon of the stored type.
  double epsilon() const { return epsilon_; }

  /// Reads all of the dataset, or the block of these extents that starts at `begin`; the last index
  /// varies fastest.
  std::vector<double> read() const;
  std::vector<double> read(Extents const& begin, Extents const& extents) const;

  [[noreturn]] void refuse(std::string const& reason) const;
  [[noreturn]] void refuse_extents(std::string const& accepted) const;

 private:
  std::filesystem::path path_;
  std::string name_;
  FileHandle file_;
  DatasetHandle dataset_;
  Extents extents_;
  double epsilon_ = 0;
};

}  // namespace cayspin::inline v0_2::io
