// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "new_file.hpp"

#include "hdf5/error.hpp"
#include "open_file_space.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string>

namespace cayspin::io {
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

// Writing to the old file is only tried, so that one which is protected, or locked by HDF5 in
// another program, is not replaced behind its back.
void require_replaceable(fs::path const& path) {
  int const file = ::open(path.c_str(), O_RDWR | O_CLOEXEC);
  if (file < 0) throw_failure(path, action, std::strerror(errno));
  bool const locked = ::flock(file, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(file);
  if (locked) throw_failure(path, action, "another program has it open");
}

// Here as always, HDF5 is not to be the one that finds the disk full.
void create_with_room(fs::path const& written, fs::path const& path, bool may_exist) {
  int const flags = O_WRONLY | O_CREAT | O_CLOEXEC | (may_exist ? 0 : O_EXCL);
  int const file = ::open(written.c_str(), flags, 0666);
  if (file < 0) throw_failure(path, action, std::strerror(errno));
  int const error = take_room(file, 0, room_for_header);
  ::close(file);
  if (error == 0) return;
  ::unlink(written.c_str());
  throw_failure(path, action, std::strerror(error));
}

}  // namespace

NewFile::NewFile(fs::path path, bool overwrite, bool always_beside)
    : path_(std::move(path)), target_(path_), written_(path_) {
  require_folder(path_);
  std::error_code error;
  auto const status = fs::status(path_, error);
  bool const replaces = fs::exists(status);
  if (replaces && !fs::is_regular_file(status))
    throw_failure(path_, action, "it exists and is not a regular file");
  if (replaces && !overwrite)
    throw_failure(path_, action, "it exists (choose another name, or overwrite with --overwrite)");
  if (replaces) {
    if (!always_beside) require_replaceable(path_);
    target_ = fs::canonical(path_);
  }
  bool const beside = replaces || always_beside;
  if (beside) written_ = target_.string() + ".partial";
  create_with_room(written_, path_, beside);
  file_ = FileHandle(H5Fcreate(written_.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT));
  if (file_.get() >= 0) return;
  auto const reason = failure_reason();
  ::unlink(written_.c_str());
  throw_failure(path_, action, reason);
}

NewFile::~NewFile() {
  if (file_.get() < 0) return;
  file_.close();
  std::error_code ignored;
  fs::remove(written_, ignored);
}

FileHandle NewFile::commit() {
  std::error_code error;
  if (written_ != target_) fs::rename(written_, target_, error);
  if (error) throw_failure(path_, action, error.message());
  return std::move(file_);
}

}  // namespace cayspin::io
