// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "new_file.hpp"

#include "files/durable.hpp"
#include "files/journal.hpp"
#include "format.hpp"
#include "hdf5/error.hpp"
#include "open_file_space.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

constexpr char const* action = "cannot create the file";
constexpr std::uint64_t room_for_header = 512 * 1024;

void require_folder(fs::path const& path) {
  auto const folder = path.has_parent_path() ? path.parent_path() : fs::path(".");
  std::error_code error;
  if (fs::is_directory(folder, error)) return;
  auto const exists = fs::exists(folder, error);
  if (error) throw_failure(path, action, error.message());
  throw_failure(path, action,
                "the folder " + folder.string() + (exists ? " is a file" : " does not exist"));
}

bool is_locked(int file) { return ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK; }

// Opens the old file for writing and tests its lock: a file that is protected, or open in this
// program or another one, must not be replaced.
void require_replaceable(fs::path const& path) {
  int const file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) throw_failure(path, action, std::strerror(errno));
  bool const locked = is_locked(file);
  ::close(file);
  if (locked)
    throw_failure(
        path, action,
        "this program or another one has it open; accepted: a closed file, or another name");
}

// Creates a file, and checks that the disk has space for its header, so that HDF5 does not find the
// disk full. Space is allocated for this check only if the disk may be full: HDF5 truncates the
// file, and a file system may take milliseconds to free its space.
void create_with_room(fs::path const& written, fs::path const& path) {
  int const file = ::open(written.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0666);
  if (file < 0) throw_failure(path, action, std::strerror(errno));
  if (is_locked(file)) {
    ::close(file);
    throw_failure(path, action, "another program is writing " + written.string());
  }
  bool const fits = has_plenty_of_room(file) && !passes_size_limit(room_for_header);
  int const error = fits ? 0 : take_room(file, 0, room_for_header);
  ::close(file);
  if (error == 0) return;
  ::unlink(written.c_str());
  throw_failure(path, action, std::strerror(error));
}

// A kill can stop a write between two pages of memory, and HDF5 refuses a block of metadata whose
// checksum is wrong. Therefore each block smaller than a page is placed within one page. The
// superblock has version 2: in version 3, a flag marks files being written; a kill would leave it
// set, and other programs would refuse the file.
FileHandle create_file(fs::path const& written, fs::path const& path, SyncedFile* synced) {
  PropertyHandle const creation(H5Pcreate(H5P_FILE_CREATE)), access(H5Pcreate(H5P_FILE_ACCESS));
  H5Pset_attr_phase_change(creation.get(), 64, 0);
  H5Pset_link_phase_change(creation.get(), 64, 0);
  H5Pset_file_space_strategy(creation.get(), H5F_FSPACE_STRATEGY_PAGE, false, 1);
  H5Pset_file_space_page_size(creation.get(), file_page_bytes);
  H5Pset_libver_bounds(access.get(), H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  if (synced) synced->use_in(access.get());
  FileHandle file(H5Fcreate(written.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()));
  if (file.get() < 0) {
    auto const reason = failure_reason();  // closing the properties would clear it
    ::unlink(written.c_str());
    throw_failure(path, action, reason);
  }
  H5Fset_libver_bounds(file.get(), H5F_LIBVER_V110, H5F_LIBVER_LATEST);
  return file;
}

// Renames `from` to `to`. Unless `replaces`, fails if a file has appeared under the new name,
// provided that the file system supports this check. Returns errno, or 0.
int put_in_place(fs::path const& from, fs::path const& to, bool replaces) {
  if (!replaces) {
    if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return 0;
    if (errno != EINVAL && errno != ENOSYS) return errno;
  }
  return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

}  // namespace

NewFile::NewFile(fs::path path, bool overwrite, bool shared, SyncedFile* synced, char const* ending)
    : path_(std::move(path)), target_(path_), synced_(synced) {
  require_folder(path_);
  std::error_code error;
  auto const status = fs::status(path_, error);
  replaces_ = fs::exists(status);
  if (replaces_ && !fs::is_regular_file(status))
    throw_failure(path_, action, "it exists and is not a regular file");
  if (replaces_ && !overwrite)
    throw_failure(path_, action, "it exists (choose another name, or overwrite with --overwrite)");
  if (replaces_) {
    if (!shared) require_replaceable(path_);
    target_ = fs::canonical(path_);
    complete_from_journal(target_);
  } else {
    target_ = followed(path_);
  }
  written_ = target_.string() + ending;
  create_with_room(written_, path_);
  file_ = create_file(written_, path_, synced_);
}

NewFile::~NewFile() {
  if (file_.get() < 0) return;
  file_.close();
  std::error_code ignored;
  fs::remove(written_, ignored);
}

FileHandle NewFile::commit() {
  if (synced_) synced_->begin(target_);
  int error = put_in_place(written_, target_, replaces_);
  if (error == 0 && synced_) error = sync_folder_of(target_);
  if (error != 0) throw_failure(path_, action, std::strerror(error));
  return std::move(file_);
}

}  // namespace cayspin::inline v0_2::io
