// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "files/durable.hpp"
#include "hdf5/handle.hpp"

#include <cstdint>
#include <filesystem>

namespace cayspin::inline v0_1::io {

/// Takes room on disk for the bytes from `begin` to `end` of a file: 0, or the system's error
/// number where there is none. A file system that cannot tell counts as one with room.
int take_room(int descriptor, std::uint64_t begin, std::uint64_t end);

/// The room on disk of a file that HDF5 has open for writing.
///
/// A disk that fills while HDF5 writes leaves a torn file. So the room is taken beforehand.
class OpenFileSpace {
 public:
  OpenFileSpace() = default;
  OpenFileSpace(hid_t file, std::filesystem::path const& path);

  /// Makes sure of room for `bytes` more, or throws with the file as it was.
  void reserve(std::uint64_t bytes, std::filesystem::path const& path);

  /// Gives back what was reserved and not used. To be called on a flushed file.
  void trim() const;

  /// Waits until a flushed file is on the disk: 0, or the system's error number.
  int sync() const { return sync_file(descriptor_); }

 private:
  std::uint64_t used() const;

  hid_t file_ = H5I_INVALID_HID;
  int descriptor_ = -1;
  std::uint64_t reserved_ = 0;
};

}  // namespace cayspin::inline v0_1::io
