// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
// Available memory of a process, read from a tree of files that replaces /proc and /sys.
#include "files/available_memory.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <string>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

class AvailableMemory : public ::testing::Test {
 protected:
  AvailableMemory() : root_(fs::path(::testing::TempDir()) / "cayspin_available_memory") {
    fs::remove_all(root_);
    write("proc/meminfo",
          "MemTotal:       32000 kB\nMemFree:          100 kB\nMemAvailable:    8000 kB\n");
  }
  ~AvailableMemory() override { fs::remove_all(root_); }

  void write(std::string const& path, std::string const& text) {
    fs::create_directories((root_ / path).parent_path());
    std::ofstream(root_ / path) << text;
  }
  void group_2(std::string const& name, std::string const& limit, std::string const& usage) {
    auto const folder = "sys/fs/cgroup/" + name;
    write(folder + "memory.max", limit + "\n");
    write(folder + "memory.current", usage + "\n");
  }
  void group_1(std::string const& name, std::string const& limit, std::string const& usage) {
    auto const folder = "sys/fs/cgroup/memory/" + name;
    write(folder + "memory.limit_in_bytes", limit + "\n");
    write(folder + "memory.usage_in_bytes", usage + "\n");
  }
  std::int64_t bytes() const { return available_memory(root_); }

 private:
  fs::path root_;
};

TEST_F(AvailableMemory, OfTheMachine) {
  EXPECT_EQ(bytes(), 8000 * 1024);
  write("proc/self/cgroup", "0::/\n");  // a group without a limit
  EXPECT_EQ(bytes(), 8000 * 1024);
  write("proc/meminfo", "MemTotal: 1 kB\n");
  EXPECT_EQ(bytes(), std::numeric_limits<std::int64_t>::max());
}

TEST_F(AvailableMemory, OfAJob) {
  write("proc/self/cgroup", "0::/system.slice/job_7/step_0\n");
  group_2("system.slice/job_7/step_0/", "max", "70000");
  group_2("system.slice/job_7/", "1000000", "70000");
  EXPECT_EQ(bytes(), 930000);
  // The kernel counts file caches as used memory, but drops them when memory is needed.
  write("sys/fs/cgroup/system.slice/job_7/memory.stat",
        "anon 10000\nfile 60000\ninactive_file 40000\nactive_file 15000\n");
  EXPECT_EQ(bytes(), 985000);
  // The group with the least available memory decides, or the machine if it has less.
  group_2("system.slice/", "500000", "450000");
  EXPECT_EQ(bytes(), 50000);
  group_2("system.slice/", "20000000", "0");
  group_2("system.slice/job_7/", "20000000", "0");
  EXPECT_EQ(bytes(), 8000 * 1024);
  group_2("system.slice/job_7/step_0/", "300", "400");
  EXPECT_EQ(bytes(), 0);
}

TEST_F(AvailableMemory, OfAContainer) {
  // In a container, the files of its group are in /sys/fs/cgroup itself, even if /proc/self/cgroup
  // states the path on the host.
  group_2("", "1000000", "100000");
  for (auto const* const name : {"0::/\n", "0::/docker/4f2a\n", "0::/../outside\n"}) {
    write("proc/self/cgroup", name);
    EXPECT_EQ(bytes(), 900000) << name;
  }
}

TEST_F(AvailableMemory, OfGroupsOfVersion1) {
  write("proc/self/cgroup", "9:name=systemd:/\n4:cpu,memory:/jobs/7\n3:cpuset:/\n0::/\n");
  group_1("", "9223372036854771712", "12000000");
  EXPECT_EQ(bytes(), 8000 * 1024);
  group_1("jobs/7/", "1000000", "400000");
  write("sys/fs/cgroup/memory/jobs/7/memory.stat",
        "inactive_file 1\ntotal_inactive_file 20000\ntotal_active_file 5000\n");
  EXPECT_EQ(bytes(), 625000);
  group_1("jobs/", "600000", "500000");
  EXPECT_EQ(bytes(), 100000);
}

TEST_F(AvailableMemory, AGroupOfVersion1WithoutALimitLimitsNothing) {
  write("proc/self/cgroup", "4:memory:/jobs/7\n");
  group_1("jobs/7/", "9223372036854771712", "9223372036854771000");
  EXPECT_EQ(bytes(), 8000 * 1024);
}

TEST(AvailableMemoryHere, IsSomething) {
  EXPECT_GT(available_memory(), 0);
  EXPECT_LT(available_memory(), std::numeric_limits<std::int64_t>::max());
}

}  // namespace
}  // namespace cayspin::inline v0_2::io
