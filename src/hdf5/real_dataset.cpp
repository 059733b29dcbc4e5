// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "real_dataset.hpp"

#include "error.hpp"

#include <fmt/ranges.h>

#include <cstdint>
#include <utility>

namespace cayspin::inline v0_2::io {
namespace {

// h5py stores booleans as an enumeration of FALSE = 0 and TRUE = 1.
bool is_boolean(hid_t type) {
  if (H5Tget_class(type) != H5T_ENUM || H5Tget_size(type) != 1 || H5Tget_nmembers(type) != 2)
    return false;
  std::int8_t no = -1, yes = -1;
  return H5Tenum_valueof(type, "FALSE", &no) >= 0 && H5Tenum_valueof(type, "TRUE", &yes) >= 0 &&
         no == 0 && yes == 1;
}

bool is_exact_in_double(std::uint64_t magnitude) {
  auto const lowest_bit = magnitude & (0 - magnitude);
  return magnitude == 0 || magnitude / lowest_bit >> std::numeric_limits<double>::digits == 0;
}

bool is_exact_in_double(std::int64_t value) {
  auto const bits = static_cast<std::uint64_t>(value);
  return is_exact_in_double(value < 0 ? 0 - bits : bits);
}

}  // namespace

RealDataset::RealDataset(std::filesystem::path path, std::string name, Accepted accepted)
    : path_(std::move(path)), name_(std::move(name)) {
  QuietErrors const quiet;
  file_ = open_file(path_);
  dataset_ = open_dataset(file_.get(), name_.c_str(), path_);
  DatatypeHandle const type(
      check(H5Dget_type(dataset_.get()), path_, "cannot read dataset " + name_));
  auto const kind = H5Tget_class(type.get());
  auto const bytes = H5Tget_size(type.get());
  if (kind == H5T_FLOAT && (bytes == sizeof(float) || bytes == sizeof(double))) {
    if (bytes == sizeof(float))
      epsilon_ = static_cast<double>(std::numeric_limits<float>::epsilon());
  } else if (accepted == Accepted::reals) {
    refuse("its type is neither float nor double; accepted: float, double");
  } else if (kind == H5T_INTEGER && bytes <= sizeof(std::int64_t)) {
    is_long_ = bytes > sizeof(std::int32_t);
    is_signed_ = H5Tget_sign(type.get()) != H5T_SGN_NONE;
  } else if (!is_boolean(type.get())) {
    refuse(
        "its type is not one of numbers; accepted: float, double, integers of up to 64 bits, "
        "booleans of h5py");
  }
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
  if (is_long_)
    return is_signed_ ? read_long<std::int64_t>(H5T_NATIVE_INT64, begin, extents)
                      : read_long<std::uint64_t>(H5T_NATIVE_UINT64, begin, extents);
  QuietErrors const quiet;
  std::vector<double> values(elements(extents));
  read_block(dataset_.get(), H5T_NATIVE_DOUBLE, begin, extents, values.data(), path_);
  return values;
}

template <class Integer>
std::vector<double> RealDataset::read_long(hid_t memory_type, Extents const& begin,
                                           Extents const& extents) const {
  QuietErrors const quiet;
  std::vector<Integer> integers(elements(extents));
  read_block(dataset_.get(), memory_type, begin, extents, integers.data(), path_);
  std::vector<double> values;
  values.reserve(integers.size());
  for (auto const integer : integers) {
    if (!is_exact_in_double(integer))
      refuse(
          fmt::format("it contains {}; accepted: integers that double represents exactly, such "
                      "as those up to 2^53",
                      integer));
    values.push_back(static_cast<double>(integer));
  }
  return values;
}

void RealDataset::refuse(std::string const& reason) const {
  throw_failure(path_, "cannot read dataset " + name_, reason);
}

void RealDataset::refuse_extents(std::string const& accepted) const {
  refuse(fmt::format("its extents are ({}); accepted: {}", fmt::join(extents_, ", "), accepted));
}

}  // namespace cayspin::inline v0_2::io
