// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "files/durable.hpp"
#include "hdf5/handle.hpp"

#include <cstdint>
#include <filesystem>

namespace cayspin::inline v0_2::io {

/// Returns true if files of this size are above the process's limit. Writing such a file would
/// raise a signal that ends the program.
bool passes_size_limit(std::uint64_t size);

/// Returns true if the disk with this file is known to be far from full.
bool has_plenty_of_room(int descriptor);

/// Allocates disk space for the bytes from `begin` to `end` of a file. Returns 0, or the system's
/// error number if the disk has too little space, or if the process may not write files of that
/// size. A file system that cannot allocate beforehand counts as having space.
int take_room(int descriptor, std::uint64_t begin, std::uint64_t end);

/// Disk space of a file that HDF5 has open for writing.
///
/// A disk that fills up while HDF5 writes leaves a torn file, so space is allocated beforehand.
class OpenFileSpace {
 public:
  OpenFileSpace() = default;
  OpenFileSpace(hid_t file, std::filesystem::path const& path);

  /// Allocates space for `bytes` more bytes. If it throws, what HDF5 has written is unchanged.
  void reserve(std::uint64_t bytes, std::filesystem::path const& path);

  bool has_plenty() const { return has_plenty_of_room(descriptor_); }

  /// Frees reserved space that was not used. Call it on a flushed file.
  void trim() const;

  /// Waits until a flushed file is on the disk. Returns 0, or the system's error number.
  int sync() const { return sync_file(descriptor_); }

 private:
  std::uint64_t used() const;

  hid_t file_ = H5I_INVALID_HID;
  int descriptor_ = -1;
  std::uint64_t reserved_ = 0;
};

}  // namespace cayspin::inline v0_2::io
