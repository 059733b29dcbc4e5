// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "files/journal.hpp"

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>

namespace cayspin::inline v0_1::io {

/// A file that HDF5 writes and that a power cut leaves as it was at the last commit().
///
/// HDF5 writes over its own blocks. What it writes over committed bytes stays in memory until
/// commit(), which puts it into a journal before the file. What it appends goes to the file at
/// once: nothing that is committed refers to it.
class SyncedFile {
 public:
  SyncedFile();
  ~SyncedFile();
  SyncedFile(SyncedFile const&) = delete;
  SyncedFile& operator=(SyncedFile const&) = delete;

  /// Makes HDF5 open and close a file through this object, which has to outlive it.
  void use_in(hid_t file_access);

  /// To be written into the file, and 8 bytes that no other file has.
  std::uint64_t mark() const { return mark_; }

  /// The first commit of a file that is to be named `path`, with a journal beside that. Throws
  /// std::runtime_error.
  void begin(std::filesystem::path const& path);

  // What follows returns 0, or the system's error number. After an error nothing is committed.

  /// All that was written is there after a power cut. The file has to be flushed.
  int commit();

  // For HDF5's driver.
  int open(char const* name, int flags);
  int read(std::uint64_t offset, void* data, std::size_t bytes) const;
  int write(std::uint64_t offset, void const* data, std::size_t bytes);
  /// Commits, cuts the file to its end and removes the journal.
  int close();
  int* descriptor() { return &file_; }
  std::uint64_t end = 0;          ///< of what HDF5 has allocated
  std::uint64_t written_end = 0;  ///< of what stands in the file

 private:
  int write_over(std::uint64_t offset, std::byte const* data, std::size_t bytes);
  int put_appended_on_disk() const;
  int put_over_committed();
  std::optional<std::uint64_t> place_of_mark() const;
  int failed(int error);

  int file_ = -1;
  std::uint64_t mark_;
  std::uint64_t committed_end_ = 0;
  std::map<std::uint64_t, Sector> over_;  // by offset: not yet committed
  std::optional<Journal> journal_;
  bool half_applied_ = false;
  int error_ = 0;
};

}  // namespace cayspin::inline v0_1::io
