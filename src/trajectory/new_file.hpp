// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/handle.hpp"

#include <filesystem>

namespace cayspin::io {

/// An HDF5 file in the making, which takes its place only when commit() says so. A new name is
/// written directly; an existing file stays untouched beside PATH.partial until then. With
/// `always_beside` a new name is written so, too, and an existing file may have readers.
class NewFile {
 public:
  NewFile(std::filesystem::path path, bool overwrite, bool always_beside = false);
  /// Uncommitted: removes what the constructor created.
  ~NewFile();
  NewFile(NewFile const&) = delete;
  NewFile& operator=(NewFile const&) = delete;

  hid_t get() const { return file_.get(); }

  /// Puts the file, flushed before, under its name and hands it over.
  FileHandle commit();

 private:
  std::filesystem::path path_;  // as given
  std::filesystem::path target_;
  std::filesystem::path written_;
  FileHandle file_;
};

}  // namespace cayspin::io
