// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "handle.hpp"

#include <hdf5.h>

#include <filesystem>
#include <string>

namespace cayspin::inline v0_1::io {

/// While in scope, no other thread of the library uses HDF5, which need not be built for several,
/// and HDF5 does not print its error stack.
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

/// Why the last HDF5 call failed: the system's own words where it has some, else the innermost line
/// of HDF5's error stack. To be asked before any other HDF5 call.
std::string failure_reason();

/// Throws std::runtime_error("PATH: ACTION: REASON").
[[noreturn]] void throw_failure(std::filesystem::path const& path, std::string const& action,
                                std::string const& reason);

/// Returns what an HDF5 call returned, or throws if that says it failed.
template <class Result>
Result check(Result result, std::filesystem::path const& path, std::string const& action) {
  if (result < 0) throw_failure(path, action, failure_reason());
  return result;
}

}  // namespace cayspin::inline v0_1::io
