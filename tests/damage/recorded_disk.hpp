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

/// An operation on a file of the recorded folder, or (`told`) a note that the test adds. Files are
/// numbered.
struct DiskEvent {
  enum Kind { write, resize, sync, create, rename, unlink, sync_folder, told } kind;
  std::size_t file = 0;
  std::uint64_t offset = 0;  // of a write; of resize and sync: the size; of told: a number
  std::string bytes = {};
  std::string name = {}, new_name = {};
};

/// Names of files, and their contents.
using DiskState = std::map<std::string, std::string>;

/// Starts to record the calls of this process that change files in `folder`, which already holds
/// `state`.
void record_disk(std::filesystem::path const& folder, DiskState const& state = {});
/// Adds an event `told` with this number. Returns the number of events, including this one.
std::size_t note_told(std::uint64_t number);
std::vector<DiskEvent> stop_recording();

/// A function that returns a number from 0 to `end` - 1.
using Choose = std::function<std::size_t(std::size_t end)>;

/// Returns what a power cut before event number `cut` may leave. Synchronised data are there. For
/// each other sector of a write and each other change of a name, choose(2) decides whether it is
/// there; `choose` also picks one of the sizes that a file has had since its last synchronisation.
/// `choose_order` decides the order in which these writes reach the disk.
DiskState after_power_cut(std::vector<DiskEvent> const& events, std::size_t cut,
                          Choose const& choose, Choose const& choose_order);

}  // namespace cayspin::test
