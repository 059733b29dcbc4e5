// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <string>
#include <vector>

namespace cayspin::io::detail {

/// A float or double dataset of an HDF5 file, open for reading as double.
/// Every member throws std::runtime_error with one line that names the file.
class Hdf5Dataset {
 public:
  Hdf5Dataset(std::filesystem::path const& path, std::string name);
  Hdf5Dataset(Hdf5Dataset const&) = delete;
  Hdf5Dataset& operator=(Hdf5Dataset const&) = delete;
  ~Hdf5Dataset();

  std::vector<hsize_t> const& extents() const { return extents_; }
  /// "(2, 1, 1, 100, 3)"
  std::string shape() const;
  /// Machine epsilon of the stored type.
  double epsilon() const { return epsilon_; }

  std::vector<double> read() const;
  /// The last entry along the first axis.
  std::vector<double> read_last() const;

 private:
  void open();
  void close();
  std::vector<double> read(hid_t file_space, std::vector<hsize_t> const& count) const;
  [[noreturn]] void fail(std::string const& reason) const;

  std::filesystem::path path_;
  std::string name_;
  hid_t file_ = H5I_INVALID_HID;
  hid_t dataset_ = H5I_INVALID_HID;
  std::vector<hsize_t> extents_;
  double epsilon_ = 0;
};

}  // namespace cayspin::io::detail
