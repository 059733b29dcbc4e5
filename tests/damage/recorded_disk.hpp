// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace cayspin::test {

/// What a program did to the files of a folder, in order. Files have numbers.
struct DiskEvent {
  enum Kind { write, resize, sync, create, rename, unlink, sync_folder, told } kind;
  std::size_t file = 0;
  std::uint64_t offset = 0;  // of a write; otherwise the file's size
  std::string bytes = {};
  std::string name = {}, new_name = {};
};

/// Names of files, and what they hold.
using DiskState = std::map<std::string, std::string>;

/// Records the calls of this process from here on, for files in `folder`, which holds `state`.
void record_disk(std::filesystem::path const& folder, DiskState const& state = {});
/// Notes a number that the caller knows the meaning of. Returns how many events are before a cut
/// after it.
std::size_t note_told(std::uint64_t number);
std::vector<DiskEvent> stop_recording();

/// A number from 0 to `end` - 1.
using Choose = std::function<std::size_t(std::size_t end)>;

/// What a power cut before event number `cut` may leave. What was synchronised is there. Of all
/// else `choose` says for each sector of each write, each size and each name whether it is.
DiskState after_power_cut(std::vector<DiskEvent> const& events, std::size_t cut,
                          Choose const& choose, Choose const& choose_order);

}  // namespace cayspin::test
