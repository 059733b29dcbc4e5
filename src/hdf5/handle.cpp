// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "handle.hpp"

#include "error.hpp"
#include "files/journal.hpp"

#include <mutex>

namespace cayspin::inline v0_2::io {
namespace {

thread_local int depth_of_turns = 0;  // number of TurnOfHdf5 scopes of this thread

std::mutex& one_at_a_time() {
  static auto& mutex = *new std::mutex;  // never destroyed: it may be used while the program ends
  return mutex;
}

}  // namespace

TurnOfHdf5::TurnOfHdf5() {
  if (depth_of_turns++ == 0) one_at_a_time().lock();
}

TurnOfHdf5::~TurnOfHdf5() {
  if (--depth_of_turns == 0) one_at_a_time().unlock();
}

namespace {

FileHandle open_with(PropertyHandle const& access, std::filesystem::path const& path) {
  std::string const action = "cannot open the file";
  // HDF5 would open a pipe, and then wait for a process at the pipe's other end.
  std::error_code ignored;
  auto const status = std::filesystem::status(path, ignored);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status))
    throw_failure(path, action, "it is not a regular file");
  complete_from_journal(path);
  FileHandle file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, access.get()));
  if (file.get() >= 0) return file;
  auto reason = failure_reason();
  if (reason == "file signature not found") reason = "it is not an HDF5 file";
  if (reason == "Resource temporarily unavailable") reason = "another program is writing it";
  throw_failure(path, action, reason);
}

}  // namespace

FileHandle open_file(std::filesystem::path const& path, Locking locking) {
  PropertyHandle const access(H5Pcreate(H5P_FILE_ACCESS));
#if H5_VERSION_GE(1, 10, 7)
  if (locking == Locking::off) H5Pset_file_locking(access.get(), false, true);
#endif
  return open_with(access, path);
}

FileHandle open_file_in_memory(std::filesystem::path const& path) {
  PropertyHandle const access(H5Pcreate(H5P_FILE_ACCESS));
  constexpr std::size_t growth = 1 << 20;
  H5Pset_fapl_core(access.get(), growth, false);
  return open_with(access, path);
}

GroupHandle create_group(hid_t parent, char const* name, std::filesystem::path const& path) {
  return GroupHandle(check(H5Gcreate2(parent, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), path,
                           std::string("cannot create group ") + name));
}

GroupHandle open_group(hid_t parent, char const* name, std::filesystem::path const& path) {
  return GroupHandle(
      check(H5Gopen2(parent, name, H5P_DEFAULT), path, std::string("cannot open group ") + name));
}

}  // namespace cayspin::inline v0_2::io
