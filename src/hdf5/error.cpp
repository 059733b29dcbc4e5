// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "error.hpp"

#include <algorithm>
#include <stdexcept>

namespace cayspin::inline v0_2::io {
namespace {

herr_t keep_description(unsigned, H5E_error2_t const* error, void* data) {
  auto& reason = *static_cast<std::string*>(data);
  if (reason.empty() && error->desc) reason = error->desc;
  return 0;
}

// Extracts the system's message from the message of a file driver: "..., error message = 'No space
// left on device', ...".
std::string system_words(std::string const& description) {
  std::string const opening = "error message = '";
  auto const begin = description.find(opening);
  if (begin == std::string::npos) return description;
  auto const words = description.substr(begin + opening.size());
  return words.substr(0, words.find('\''));
}

}  // namespace

// At exit, HDF5 would close open files, and crash on a file whose disk has failed. This library
// leaves no file open, so it turns this clean-up off. That has to be done before HDF5 is
// initialised.
QuietErrors::QuietErrors() {
  [[maybe_unused]] static auto const told = H5dont_atexit();
  H5Eget_auto2(H5E_DEFAULT, &function_, &data_);
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

QuietErrors::~QuietErrors() { H5Eset_auto2(H5E_DEFAULT, function_, data_); }

std::string failure_reason() {
  std::string reason;
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, keep_description, &reason);
  if (reason.empty()) return "HDF5 gives no reason";
  reason = system_words(reason);
  std::replace(reason.begin(), reason.end(), '\n', ' ');
  return reason;
}

void throw_failure(std::filesystem::path const& path, std::string const& action,
                   std::string const& reason) {
  throw std::runtime_error(path.string() + ": " + action + ": " + reason);
}

}  // namespace cayspin::inline v0_2::io
