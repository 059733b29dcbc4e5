// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <hdf5.h>

#include <filesystem>
#include <utility>

namespace cayspin::inline v0_2::io {

/// While in scope, no other thread of the library uses HDF5. Scopes may be nested. A child process
/// that is forked in a scope holds the lock, too. If the lock were a std::recursive_mutex, the
/// child would not own it.
class TurnOfHdf5 {
 public:
  TurnOfHdf5();
  ~TurnOfHdf5();
  TurnOfHdf5(TurnOfHdf5 const&) = delete;
  TurnOfHdf5& operator=(TurnOfHdf5 const&) = delete;
};

/// Owns one HDF5 identifier and closes it with `Close`.
template <herr_t (*Close)(hid_t)>
class Handle {
 public:
  Handle() = default;
  explicit Handle(hid_t id) : id_(id) {}
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    return *this;
  }
  ~Handle() { close(); }

  hid_t get() const { return id_; }

  /// Closes the identifier now, and returns the result of `Close`. The destructor ignores it.
  herr_t close() {
    auto const id = std::exchange(id_, H5I_INVALID_HID);
    if (id < 0) return 0;
    TurnOfHdf5 const turn;
    return Close(id);
  }

 private:
  hid_t id_ = H5I_INVALID_HID;
};

using FileHandle = Handle<H5Fclose>;
using GroupHandle = Handle<H5Gclose>;
using DatasetHandle = Handle<H5Dclose>;
using DataspaceHandle = Handle<H5Sclose>;
using DatatypeHandle = Handle<H5Tclose>;
using AttributeHandle = Handle<H5Aclose>;
using PropertyHandle = Handle<H5Pclose>;

/// Whether a file that is read is locked against writers. Without the lock, a reader may see data
/// of which another process has written only a part.
enum class Locking { on, off };

/// Opens an existing file for reading. Completes it first if a power cut or a kill has left a
/// journal.
FileHandle open_file(std::filesystem::path const& path, Locking locking = Locking::on);
/// Reads all of a small file into memory and opens it there. No process may be writing it.
FileHandle open_file_in_memory(std::filesystem::path const& path);

// Create or open a group. `path`: the file, for error messages.
GroupHandle create_group(hid_t parent, char const* name, std::filesystem::path const& path);
GroupHandle open_group(hid_t parent, char const* name, std::filesystem::path const& path);

}  // namespace cayspin::inline v0_2::io
