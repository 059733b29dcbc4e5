// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "real_dataset.hpp"

#include "error.hpp"

#include <fmt/ranges.h>

#include <limits>
#include <utility>

namespace cayspin::inline v0_2::io {

RealDataset::RealDataset(std::filesystem::path path, std::string name)
    : path_(std::move(path)), name_(std::move(name)) {
  QuietErrors const quiet;
  file_ = open_file(path_);
  dataset_ = open_dataset(file_.get(), name_.c_str(), path_);
  DatatypeHandle const type(
      check(H5Dget_type(dataset_.get()), path_, "cannot read dataset " + name_));
  auto const bytes = H5Tget_size(type.get());
  if (H5Tget_class(type.get()) != H5T_FLOAT || (bytes != sizeof(float) && bytes != sizeof(double)))
    refuse("its type is neither float nor double; accepted: float, double");
  epsilon_ = bytes == sizeof(float) ? static_cast<double>(std::numeric_limits<float>::epsilon())
                                    : std::numeric_limits<double>::epsilon();
  extents_ = dataset_extents(dataset_.get(), path_);
}

Extents RealDataset::chunk() const {
  QuietErrors const quiet;
  auto const action = "cannot read dataset " + name_;
  Extents chunk(extents_.size(), 1);
  PropertyHandle const properties(check(H5Dget_create_plist(dataset_.get()), path_, action));
  if (H5Pget_layout(properties.get()) == H5D_CHUNKED)
    check(H5Pget_chunk(properties.get(), static_cast<int>(chunk.size()), chunk.data()), path_,
          action);
  return chunk;
}

std::vector<double> RealDataset::read() const { return read(Extents(extents_.size()), extents_); }

std::vector<double> RealDataset::read(Extents const& begin, Extents const& extents) const {
  QuietErrors const quiet;
  std::vector<double> values(elements(extents));
  read_block(dataset_.get(), H5T_NATIVE_DOUBLE, begin, extents, values.data(), path_);
  return values;
}

void RealDataset::refuse(std::string const& reason) const {
  throw_failure(path_, "cannot read dataset " + name_, reason);
}

void RealDataset::refuse_extents(std::string const& accepted) const {
  refuse(fmt::format("its extents are ({}); accepted: {}", fmt::join(extents_, ", "), accepted));
}

}  // namespace cayspin::inline v0_2::io
