// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "handle.hpp"

#include <hdf5.h>

#include <filesystem>
#include <string>

namespace cayspin::inline v0_2::io {

/// While an object exists, HDF5 does not print its error stack, and no other thread of this library
/// uses HDF5, because HDF5 may be built without thread safety.
class QuietErrors {
 public:
  QuietErrors();
  ~QuietErrors();
  QuietErrors(QuietErrors const&) = delete;
  QuietErrors& operator=(QuietErrors const&) = delete;

 private:
  TurnOfHdf5 turn_;
  H5E_auto2_t function_ = nullptr;
  void* data_ = nullptr;
};

/// Returns why the last HDF5 call failed: the system's message if there is one, otherwise the
/// innermost line of HDF5's error stack. Call it directly after the failed call, because other HDF5
/// functions clear the error stack.
std::string failure_reason();

/// Throws std::runtime_error("PATH: ACTION: REASON").
[[noreturn]] void throw_failure(std::filesystem::path const& path, std::string const& action,
                                std::string const& reason);

/// Returns `result`, the result of an HDF5 call. Throws if it is negative, which means failure.
template <class Result>
Result check(Result result, std::filesystem::path const& path, std::string const& action) {
  if (result < 0) throw_failure(path, action, failure_reason());
  return result;
}

}  // namespace cayspin::inline v0_2::io
