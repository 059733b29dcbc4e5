// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "open_file_space.hpp"

#include "hdf5/error.hpp"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/statvfs.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace cayspin::inline v0_2::io {

bool passes_size_limit(std::uint64_t size) {
  rlimit limit{};
  return getrlimit(RLIMIT_FSIZE, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY &&
         size > limit.rlim_cur;
}

bool has_plenty_of_room(int descriptor) {
  constexpr std::uint64_t plenty = 1 << 30;
  struct statvfs disk {};
  return ::fstatvfs(descriptor, &disk) == 0 && disk.f_frsize > 0 &&
         disk.f_bavail > plenty / disk.f_frsize;
}

int take_room(int descriptor, std::uint64_t begin, std::uint64_t end) {
  if (passes_size_limit(end)) return EFBIG;
  auto const bytes = static_cast<off_t>(end - begin);
  while (::fallocate(descriptor, 0, static_cast<off_t>(begin), bytes) != 0) {
    if (errno == EINTR) continue;
    bool const full = errno == ENOSPC || errno == EFBIG || errno == EDQUOT;
    return full ? errno : 0;
  }
  return 0;
}

OpenFileSpace::OpenFileSpace(hid_t file, std::filesystem::path const& path) : file_(file) {
  void* descriptor = nullptr;
  check(H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor), path, "cannot create the file");
  descriptor_ = *static_cast<int*>(descriptor);
  // HDF5 would leave the file open, and locked, in programs that are started meanwhile.
  ::fcntl(descriptor_, F_SETFD, FD_CLOEXEC);
}

std::uint64_t OpenFileSpace::used() const {
  hsize_t size = 0;
  H5Fget_filesize(file_, &size);
  return size;
}

void OpenFileSpace::reserve(std::uint64_t bytes, std::filesystem::path const& path) {
  auto const wanted = used() + bytes;
  if (wanted <= reserved_) return;
  if (int const error = take_room(descriptor_, reserved_, wanted))
    throw_failure(path, "cannot write the file", std::strerror(error));
  reserved_ = wanted;
}

void OpenFileSpace::trim() const {
  [[maybe_unused]] auto const result = ::ftruncate(descriptor_, static_cast<off_t>(used()));
}

}  // namespace cayspin::inline v0_2::io
