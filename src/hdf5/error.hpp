// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "handle.hpp"

#include <hdf5.h>

#include <filesystem>
#include <string>

namespace cayspin::inline v0_2::io {

/// While in scope, no other thread of the library uses HDF5, which may be built without thread
/// safety, and HDF5 does not print its error stack.
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
/// innermost line of HDF5's error stack. Call it before any other HDF5 function.
std::string failure_reason();

/// Throws std::runtime_error("PATH: ACTION: REASON").
[[noreturn]] void throw_failure(std::filesystem::path const& path, std::string const& action,
                                std::string const& reason);

/// Returns the result of an HDF5 call; throws if it signals failure.
template <class Result>
Result check(Result result, std::filesystem::path const& path, std::string const& action) {
  if (result < 0) throw_failure(path, action, failure_reason());
  return result;
}

}  // namespace cayspin::inline v0_2::io
