// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "hdf5_dataset.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <functional>
#include <limits>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace cayspin::io::detail {
namespace {

// HDF5 prints its error stack to stderr unless told otherwise.
class QuietErrors {
 public:
  QuietErrors() {
    H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  QuietErrors(QuietErrors const&) = delete;
  QuietErrors& operator=(QuietErrors const&) = delete;
  ~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

 private:
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

}  // namespace

Hdf5Dataset::Hdf5Dataset(std::filesystem::path const& path, std::string name)
    : path_(path), name_(std::move(name)) {
  try {
    open();
  } catch (...) {
    close();
    throw;
  }
}

Hdf5Dataset::~Hdf5Dataset() { close(); }

void Hdf5Dataset::open() {
  QuietErrors const quiet;
  std::error_code error;
  auto const status = std::filesystem::status(path_, error);
  if (!std::filesystem::exists(status)) fail("no such file");
  if (!std::filesystem::is_regular_file(status)) fail("not a regular file");
  file_ = H5Fopen(path_.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file_ < 0) fail("cannot be opened as an HDF5 file");
  dataset_ = H5Dopen2(file_, name_.c_str(), H5P_DEFAULT);
  if (dataset_ < 0) fail("has no dataset " + name_);

  hid_t const type = H5Dget_type(dataset_);
  auto const type_class = H5Tget_class(type);
  auto const bytes = H5Tget_size(type);
  H5Tclose(type);
  if (type_class != H5T_FLOAT || (bytes != sizeof(float) && bytes != sizeof(double))) {
    fail("dataset " + name_ + " is not of type float or double");
  }
  epsilon_ = bytes == sizeof(float) ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                    : std::numeric_limits<double>::epsilon();

  hid_t const space = H5Dget_space(dataset_);
  extents_.resize(static_cast<std::size_t>(H5Sget_simple_extent_ndims(space)));
  H5Sget_simple_extent_dims(space, extents_.data(), nullptr);
  H5Sclose(space);
}

void Hdf5Dataset::close() {
  if (dataset_ >= 0) H5Dclose(dataset_);
  if (file_ >= 0) H5Fclose(file_);
  dataset_ = file_ = H5I_INVALID_HID;
}

void Hdf5Dataset::fail(std::string const& reason) const {
  throw std::runtime_error(fmt::format("{}: {}", path_.string(), reason));
}

std::string Hdf5Dataset::shape() const { return fmt::format("({})", fmt::join(extents_, ", ")); }

std::vector<double> Hdf5Dataset::read() const { return read(H5S_ALL, extents_); }

std::vector<double> Hdf5Dataset::read_last() const {
  std::vector<hsize_t> start(extents_.size(), 0);
  auto count = extents_;
  start.at(0) = extents_.at(0) - 1;
  count.at(0) = 1;
  hid_t const space = H5Dget_space(dataset_);
  H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr);
  try {
    auto values = read(space, count);
    H5Sclose(space);
    return values;
  } catch (...) {
    H5Sclose(space);
    throw;
  }
}

std::vector<double> Hdf5Dataset::read(hid_t file_space, std::vector<hsize_t> const& count) const {
  QuietErrors const quiet;
  std::vector<double> values(
      std::accumulate(count.begin(), count.end(), hsize_t{1}, std::multiplies<>{}));
  hid_t const memory = H5Screate_simple(static_cast<int>(count.size()), count.data(), nullptr);
  auto const status =
      H5Dread(dataset_, H5T_NATIVE_DOUBLE, memory, file_space, H5P_DEFAULT, values.data());
  H5Sclose(memory);
  if (status < 0) fail("dataset " + name_ + " cannot be read");
  return values;
}

}  // namespace cayspin::io::detail
