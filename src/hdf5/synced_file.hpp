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

/// A file that HDF5 writes. After a power cut, complete_from_journal() restores its state of the
/// last commit().
///
/// HDF5 overwrites blocks that it wrote before. New content for committed bytes stays in memory
/// until commit(), which writes it to a journal first and then to the file. Appended data go to the
/// file at once, because no committed data refer to them.
class SyncedFile {
 public:
  SyncedFile();
  ~SyncedFile();
  SyncedFile(SyncedFile const&) = delete;
  SyncedFile& operator=(SyncedFile const&) = delete;

  /// Sets the file driver of an access property list, so that HDF5 opens, reads, writes and closes
  /// its file through this object. The object must outlive the open file.
  void use_in(hid_t file_access);

  /// Returns a random number of 8 bytes that identifies the file. It must be stored in the file
  /// before begin().
  std::uint64_t mark() const { return mark_; }

  /// Commits the file for the first time, and creates its journal. `path`: the name that the file
  /// will get, next to which the journal lies. Throws std::runtime_error.
  void begin(std::filesystem::path const& path);

  // The functions below, except descriptor(), return 0 or the system's error number. After an error
  // of commit() or write(), nothing more is committed.

  /// Makes all data written so far survive a power cut. Call H5Fflush first. Does nothing before
  /// begin().
  int commit();

  // The HDF5 driver uses the members below.
  int open(char const* name, int flags);
  int read(std::uint64_t offset, void* data, std::size_t bytes) const;
  int write(std::uint64_t offset, void const* data, std::size_t bytes);
  /// Commits, truncates the file to `end`, removes the journal and closes the file. Keeps the
  /// journal if an error has left a commit half done.
  int close();
  int* descriptor() { return &file_; }
  std::uint64_t end = 0;          ///< end of the space that HDF5 has allocated
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
