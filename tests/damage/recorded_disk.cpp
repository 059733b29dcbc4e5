// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "recorded_disk.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <utility>

namespace cayspin::test {
namespace {

namespace fs = std::filesystem;

bool recording = false;
fs::path recorded_folder;
std::vector<DiskEvent> recorded;
std::map<ino_t, std::size_t> numbers;
std::size_t next_number = 0;

std::string name_of(int file) {
  std::array<char, 4096> target{};
  auto const link = "/proc/self/fd/" + std::to_string(file);
  auto const length = ::readlink(link.c_str(), target.data(), target.size());
  return length > 0 ? std::string(target.data(), static_cast<std::size_t>(length)) : "";
}

bool is_recorded(fs::path const& path) {
  return recording && fs::absolute(path).parent_path() == recorded_folder;
}

// The creation of a file is recorded just before the first other operation on it.
DiskEvent* add_event(DiskEvent::Kind kind, int file) {
  auto const name = recording ? name_of(file) : "";
  if (name.empty() || !is_recorded(name)) return nullptr;
  struct stat status {};
  ::fstat(file, &status);
  auto const [number, is_new] = numbers.try_emplace(status.st_ino, next_number);
  if (is_new) {
    ++next_number;
    recorded.push_back({.kind = DiskEvent::create,
                        .file = number->second,
                        .name = fs::path(name).filename().string()});
  }
  recorded.push_back(
      {.kind = kind, .file = number->second, .offset = static_cast<std::uint64_t>(status.st_size)});
  return &recorded.back();
}

// After a file is removed, another one may get its inode number.
void forget(char const* path) {
  struct stat status {};
  if (::stat(path, &status) == 0) numbers.erase(status.st_ino);
}

void add_rename(char const* from, char const* to) {
  recorded.push_back({.kind = DiskEvent::rename,
                      .name = fs::path(from).filename().string(),
                      .new_name = fs::path(to).filename().string()});
}

}  // namespace

void record_disk(fs::path const& folder, DiskState const& state) {
  recorded_folder = fs::canonical(folder);
  recorded.clear();
  numbers.clear();
  next_number = 0;
  for (auto const& [name, bytes] : state) {
    struct stat status {};
    ::stat((recorded_folder / name).c_str(), &status);
    numbers[status.st_ino] = next_number;
    recorded.push_back({.kind = DiskEvent::create, .file = next_number, .name = name});
    recorded.push_back({.kind = DiskEvent::write, .file = next_number, .bytes = bytes});
    recorded.push_back({.kind = DiskEvent::sync, .file = next_number++, .offset = bytes.size()});
  }
  recorded.push_back({.kind = DiskEvent::sync_folder});
  recording = true;
}

std::size_t note_told(std::uint64_t number) {
  recorded.push_back({.kind = DiskEvent::told, .offset = number});
  return recorded.size();
}

std::vector<DiskEvent> stop_recording() {
  recording = false;
  return std::move(recorded);
}

}  // namespace cayspin::test

// Intercepts the system calls of the library and of HDF5.
namespace test = cayspin::test;
using test::DiskEvent;

extern "C" ssize_t pwrite(int file, void const* data, size_t bytes, off_t offset) {
  if (auto* const event = test::add_event(DiskEvent::write, file)) {
    event->offset = static_cast<std::uint64_t>(offset);
    event->bytes.assign(static_cast<char const*>(data), bytes);
  }
  return ::syscall(SYS_pwrite64, file, data, bytes, offset);
}

extern "C" int ftruncate(int file, off_t size) noexcept {
  auto const result = static_cast<int>(::syscall(SYS_ftruncate, file, size));
  test::add_event(DiskEvent::resize, file);
  return result;
}

extern "C" int fallocate(int file, int mode, off_t offset, off_t bytes) {
  auto const result = static_cast<int>(::syscall(SYS_fallocate, file, mode, offset, bytes));
  test::add_event(DiskEvent::resize, file);
  return result;
}

extern "C" int fdatasync(int file) {
  test::add_event(DiskEvent::sync, file);
  return 0;  // the test's disk is the record
}

extern "C" int fsync(int file) {
  struct stat status {};
  if (::fstat(file, &status) != 0 || !S_ISDIR(status.st_mode)) return fdatasync(file);
  if (test::recording && test::name_of(file) == test::recorded_folder)
    test::recorded.push_back({.kind = DiskEvent::sync_folder});
  return 0;
}

extern "C" int renameat2(int from_folder, char const* from, int to_folder, char const* to,
                         unsigned flags) noexcept {
  if (test::is_recorded(to)) test::forget(to);
  auto const result =
      static_cast<int>(::syscall(SYS_renameat2, from_folder, from, to_folder, to, flags));
  if (result == 0 && test::is_recorded(to)) test::add_rename(from, to);
  return result;
}

extern "C" int rename(char const* from, char const* to) noexcept {
  return ::renameat2(AT_FDCWD, from, AT_FDCWD, to, 0);
}

extern "C" int unlink(char const* path) noexcept {
  if (test::is_recorded(path)) {
    test::forget(path);
    test::recorded.push_back(
        {.kind = DiskEvent::unlink, .name = test::fs::path(path).filename().string()});
  }
  return static_cast<int>(::syscall(SYS_unlink, path));
}
