// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <filesystem>
#include <fstream>

namespace cayspin::inline v0_2::io {

/// A file being written as PATH.partial, which commit() renames to PATH. If PATH is a symbolic
/// link, the file to which it leads is written in this way. Failures throw
/// std::runtime_error("PATH: cannot write the file: REASON").
class FileBeside {
 public:
  /// Throws if `path` exists, unless `overwrite` is true and it is a regular file.
  FileBeside(std::filesystem::path path, bool overwrite);
  /// Removes the written file unless commit() has renamed it.
  ~FileBeside();
  FileBeside(FileBeside const&) = delete;
  FileBeside& operator=(FileBeside const&) = delete;

  std::ostream& stream() { return stream_; }

  /// Gives the complete file its name. If it throws, an old file of that name is unchanged.
  void commit();

 private:
  [[noreturn]] void fail() const;

  std::filesystem::path path_, target_, partial_;
  std::ofstream stream_;
  bool committed_ = false;
};

/// Throws if `path` exists and may not be replaced: without `overwrite`, or because it is not a
/// regular file.
void require_free(std::filesystem::path const& path, bool overwrite);

}  // namespace cayspin::inline v0_2::io
