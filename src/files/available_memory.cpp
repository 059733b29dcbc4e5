// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "available_memory.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <string>
#include <string_view>

namespace cayspin::inline v0_2::io {
namespace {

namespace fs = std::filesystem;

constexpr auto unlimited = std::numeric_limits<std::int64_t>::max();

/// One version of Linux control groups: its folder, and the names of files in each group.
struct Group {
  char const* folder;
  char const* limit;
  char const* usage;
  char const*
      cached[2];  // keys of memory.stat: file caches that the kernel drops when it needs memory
};
constexpr Group version_1{"sys/fs/cgroup/memory",
                          "memory.limit_in_bytes",
                          "memory.usage_in_bytes",
                          {"total_inactive_file", "total_active_file"}};
constexpr Group version_2{
    "sys/fs/cgroup", "memory.max", "memory.current", {"inactive_file", "active_file"}};

std::optional<std::int64_t> number_in(fs::path const& path) {
  std::ifstream file(path);
  std::int64_t number = 0;
  if (file >> number) return number;
  return std::nullopt;  // "max", or no such file
}

std::optional<std::int64_t> number_after(fs::path const& path, std::string_view key) {
  std::ifstream file(path);
  for (std::string line; std::getline(file, line);)
    if (line.starts_with(key) && line.size() > key.size() && line[key.size()] == ' ')
      return std::stoll(line.substr(key.size()));
  return std::nullopt;
}

std::int64_t left_in(Group const& group, fs::path const& folder) {
  auto const limit = number_in(folder / group.limit);
  if (!limit || *limit > unlimited / 2) return unlimited;  // version 1 has a number for no limit
  auto const usage = number_in(folder / group.usage);
  if (!usage) return unlimited;
  std::int64_t used = *usage;
  for (auto const* const key : group.cached)
    used -= number_after(folder / "memory.stat", key).value_or(0);
  return std::max<std::int64_t>(0, *limit - std::max<std::int64_t>(0, used));
}

// Returns the smallest amount of memory that is left in the group `name` or in one of the groups
// that contain it. In a container only the root folder exists; it describes the container's group.
std::int64_t left_around(Group const& group, fs::path const& root, fs::path const& name) {
  auto least = unlimited;
  for (auto inner = name.relative_path();; inner = inner.parent_path()) {
    least = std::min(least, left_in(group, root / group.folder / inner));
    if (inner.empty()) return least;
  }
}

// Lines of /proc/self/cgroup have the form number:controllers:name. The line for version 2 has no
// controllers: 0::name.
std::int64_t left_in_groups(fs::path const& root) {
  auto least = unlimited;
  std::ifstream file(root / "proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    auto const first = line.find(':'), second = line.find(':', first + 1);
    if (first == line.npos || second == line.npos) continue;
    auto const controllers = ',' + line.substr(first + 1, second - first - 1) + ',';
    auto const name = line.substr(second + 1);
    if (controllers == ",,") least = std::min(least, left_around(version_2, root, name));
    if (controllers.find(",memory,") != controllers.npos)
      least = std::min(least, left_around(version_1, root, name));
  }
  return least;
}

}  // namespace

std::int64_t available_memory(fs::path const& root) {
  auto const kibibytes = number_after(root / "proc/meminfo", "MemAvailable:");
  return std::min(kibibytes ? 1024 * *kibibytes : unlimited, left_in_groups(root));
}

}  // namespace cayspin::inline v0_2::io
