// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/handle.hpp"
#include "hdf5/synced_file.hpp"

#include <filesystem>

namespace cayspin::inline v0_1::io {

/// An HDF5 file in the making, written as PATH.partial until commit(): at no moment is there a torn
/// file at PATH. An existing file stays untouched until then; with `shared` it may have readers.
/// With `synced`, which HDF5 then writes through, neither is there after a power cut.
class NewFile {
 public:
  NewFile(std::filesystem::path path, bool overwrite, bool shared = false,
          SyncedFile* synced = nullptr);
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
  bool replaces_;
  SyncedFile* synced_;
  FileHandle file_;
};

}  // namespace cayspin::inline v0_1::io
