// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "hdf5/handle.hpp"
#include "hdf5/synced_file.hpp"

#include <filesystem>

namespace cayspin::inline v0_2::io {

/// An HDF5 file that is called PATH.partial (or PATH with another `ending`) until commit(), so that
/// PATH is never incomplete. Until then, an existing file PATH is not changed, except that it is
/// completed from its journal if it has one. It is an error if another program has PATH open,
/// unless `shared`. With `synced`, HDF5 writes through that object, and PATH is complete even after
/// a power cut.
class NewFile {
 public:
  NewFile(std::filesystem::path path, bool overwrite, bool shared = false,
          SyncedFile* synced = nullptr, char const* ending = ".partial");
  /// Removes the created file unless it was committed.
  ~NewFile();
  NewFile(NewFile const&) = delete;
  NewFile& operator=(NewFile const&) = delete;

  hid_t get() const { return file_.get(); }

  /// Gives the flushed file its name, and returns the open file.
  FileHandle commit();

 private:
  std::filesystem::path path_;  // as given
  std::filesystem::path target_;
  std::filesystem::path written_;
  bool replaces_;
  SyncedFile* synced_;
  FileHandle file_;
};

}  // namespace cayspin::inline v0_2::io
