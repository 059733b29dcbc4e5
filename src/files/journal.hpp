// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <span>

namespace cayspin::inline v0_1::io {

/// What a disk writes as a whole or not at all.
inline constexpr std::size_t sector_bytes = 512;

/// A sector of a file, as it is to be.
struct Sector {
  std::uint64_t offset;
  std::array<std::byte, sector_bytes> bytes;
};

/// What stands in a file at the same place from its creation on, and in no other file.
struct FileMark {
  std::uint64_t offset, value;
};

/// PATH.journal: the sectors that are next written over those of the file PATH. As long as they
/// have not reached the disk, they can be taken from there.
class Journal {
 public:
  /// Creates the file, or empties the one that an earlier run left, and keeps it locked. Throws
  /// std::runtime_error.
  Journal(std::filesystem::path const& path, FileMark mark);
  /// Closes the file and leaves it.
  ~Journal();
  Journal(Journal const&) = delete;
  Journal& operator=(Journal const&) = delete;

  /// Puts these in place of the sectors of before, and waits for the disk. 0, or the system's error
  /// number.
  int write(std::span<Sector const> sectors) const;

  void remove() const;

 private:
  std::filesystem::path path_;
  FileMark mark_;
  int file_ = -1;
};

/// Where a power cut or a kill left a journal beside a file, completes the file from it and removes
/// the journal. Leaves both as they are while a writer has them, and what is the journal of another
/// file. Throws std::runtime_error where the file needs it and cannot be written.
void complete_from_journal(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_1::io
