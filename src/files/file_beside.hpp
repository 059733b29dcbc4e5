// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <filesystem>
#include <fstream>

namespace cayspin::inline v0_1::io {

/// A file in the making, written as PATH.partial, which takes its name when commit() says so.
/// Failures throw std::runtime_error("PATH: cannot write the file: REASON").
class FileBeside {
 public:
  /// A file that exists is an error unless `overwrite`.
  FileBeside(std::filesystem::path path, bool overwrite);
  /// Uncommitted: removes what was written.
  ~FileBeside();
  FileBeside(FileBeside const&) = delete;
  FileBeside& operator=(FileBeside const&) = delete;

  std::ostream& stream() { return stream_; }

  /// Puts the whole file under its name, or throws and leaves what was there.
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_, partial_;
  std::ofstream stream_;
  bool committed_ = false;
};

/// Throws if a file is there that may not be replaced.
void require_free(std::filesystem::path const& path, bool overwrite);

}  // namespace cayspin::inline v0_1::io
