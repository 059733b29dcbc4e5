// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "durable.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <system_error>

namespace cayspin::inline v0_2::io {

int write_all(int file, void const* data, std::size_t bytes, std::uint64_t offset) {
  auto const* from = static_cast<std::byte const*>(data);
  while (bytes > 0) {
    auto const count = ::pwrite(file, from, bytes, static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return count < 0 ? errno : EIO;
    from += count;
    offset += static_cast<std::uint64_t>(count);
    bytes -= static_cast<std::size_t>(count);
  }
  return 0;
}

int read_all(int file, void* data, std::size_t bytes, std::uint64_t offset) {
  auto* to = static_cast<std::byte*>(data);
  while (bytes > 0) {
    auto const count = ::pread(file, to, bytes, static_cast<off_t>(offset));
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) return errno;
    if (count == 0) {
      std::fill_n(to, bytes, std::byte{0});
      return 0;
    }
    to += count;
    offset += static_cast<std::uint64_t>(count);
    bytes -= static_cast<std::size_t>(count);
  }
  return 0;
}

int sync_file(int file) {
  while (::fdatasync(file) != 0) {
    if (errno == EINVAL || errno == ENOTSUP || errno == EROFS) return 0;
    if (errno != EINTR) return errno;
  }
  return 0;
}

int sync_folder_of(std::filesystem::path const& path) {
  auto const folder = path.has_parent_path() ? path.parent_path() : std::filesystem::path(".");
  int const file = ::open(folder.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (file < 0) return errno == EACCES ? 0 : errno;  // a folder that may not be read
  int const error = ::fsync(file) == 0 || errno == EINVAL || errno == ENOTSUP ? 0 : errno;
  ::close(file);
  return error;
}

std::filesystem::path followed(std::filesystem::path path) {
  constexpr int most_links = 40;  // as in Linux
  std::error_code error;
  for (int links = 0; links < most_links; ++links) {
    auto const target = std::filesystem::read_symlink(path, error);
    if (error) return path;
    path = path.parent_path() / target;
  }
  return path;
}

}  // namespace cayspin::inline v0_2::io
