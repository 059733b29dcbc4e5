// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <string>

namespace cayspin::test {

/// A new folder, in memory if the system has a memory file system.
class MemoryFolder {
 public:
  explicit MemoryFolder(std::string const& name) {
    std::filesystem::path const shared = "/dev/shm";
    auto const parent =
        ::access(shared.c_str(), W_OK) == 0 ? shared : std::filesystem::path(testing::TempDir());
    path_ = parent / ("cayspin_" + name + "_" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ~MemoryFolder() { std::filesystem::remove_all(path_); }
  MemoryFolder(MemoryFolder const&) = delete;
  MemoryFolder& operator=(MemoryFolder const&) = delete;

  std::filesystem::path const& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace cayspin::test
