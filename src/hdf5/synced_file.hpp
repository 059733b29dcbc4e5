// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "files/journal.hpp"

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

namespace cayspin::inline v0_2::io {

/// A file written by HDF5 which a power cut leaves in the state of its last commit().
///
/// HDF5 overwrites its own blocks. New content of committed bytes stays in memory until commit(),
/// which writes it to a journal before the file. Appended data go to the file at once, because no
/// committed data refer to them.
class SyncedFile {
 public:
  SyncedFile();
  ~SyncedFile();
  SyncedFile(SyncedFile const&) = delete;
  SyncedFile& operator=(SyncedFile const&) = delete;

  /// Makes HDF5 open and close a file through this object, which must outlive it.
  void use_in(hid_t file_access);

  /// Returns a random number of 8 bytes to be stored in the file, which identifies it.
  std::uint64_t mark() const { return mark_; }

  /// Commits for the first time a file that is to be named `path`, with a journal next to it.
  /// Throws std::runtime_error.
  void begin(std::filesystem::path const& path);

  // These functions return 0, or the system's error number. After an error nothing is committed.

  /// Makes all written data survive a power cut. Flush the file before.
  int commit();

  // For HDF5's driver.
  int open(char const* name, int flags);
  int read(std::uint64_t offset, void* data, std::size_t bytes) const;
  int write(std::uint64_t offset, void const* data, std::size_t bytes);
  /// Commits, truncates the file to its end and removes the journal.
  int close();
  int* descriptor() { return &file_; }
  std::uint64_t end = 0;          ///< end of what HDF5 has allocated
  std::uint64_t written_end = 0;  ///< end of the data in the file

 private:
  int write_over(std::uint64_t offset, std::byte const* data, std::size_t bytes);
  int put_appended_on_disk() const;
  int put_over_committed();
  std::optional<std::uint64_t> place_of_mark() const;
  int failed(int error);

  int file_ = -1;
  std::uint64_t mark_;
  std::uint64_t committed_end_ = 0;
  std::map<std::uint64_t, Sector> over_;  // new content not yet committed, by offset
  std::optional<Journal> journal_;
  bool half_applied_ = false;
  int error_ = 0;
};

}  // namespace cayspin::inline v0_2::io
