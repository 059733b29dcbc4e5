// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace cayspin::inline v0_2::io {

/// Size of the unit that a disk writes completely or not at all.
inline constexpr std::size_t sector_bytes = 512;

/// A sector of a file with its new content.
struct Sector {
  std::uint64_t offset;
  std::array<std::byte, sector_bytes> bytes;
};

/// A number at a fixed offset that identifies a file: set at its creation, different in every file.
struct FileMark {
  std::uint64_t offset, value;
};

/// The file PATH.journal holds new content for sectors of the file PATH. Until that content is on
/// the disk in PATH itself, it can be restored from the journal.
class Journal {
 public:
  /// Creates the file, or empties the one left by an earlier run, and locks it. Throws
  /// std::runtime_error.
  Journal(std::filesystem::path const& path, FileMark mark);
  /// Closes the file without removing it.
  ~Journal();
  Journal(Journal const&) = delete;
  Journal& operator=(Journal const&) = delete;

  /// Replaces the stored sectors by `sectors`, and waits until they are on the disk. Returns 0, or
  /// the system's error number.
  int write(std::span<Sector const> sectors) const;

  void remove() const;

 private:
  std::filesystem::path path_;
  FileMark mark_;
  int file_ = -1;
};

/// Completes a file from the journal that a power cut or a kill left next to it, and removes the
/// journal. Changes nothing while a writer has the journal locked, or if the journal belongs to
/// another file. Throws std::runtime_error if the file needs its journal and cannot be written.
void complete_from_journal(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_2::io
