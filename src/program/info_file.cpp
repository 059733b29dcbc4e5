// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "info_file.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>

namespace cayspin::program {
namespace {

// Retries for about a second, because a half-written part may soon be complete.
io::TrajectoryInfo read_beside_writer(std::filesystem::path const& file) {
  for (int tries = 20;; --tries) {
    try {
      return io::read_info_while_written(file);
    } catch (std::runtime_error const&) {
      if (tries == 1) throw;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  }
}

}  // namespace

InfoFile read_info_file(std::filesystem::path const& path) {
  auto const being_written = io::is_being_written(path);
  if (being_written != true) {
    if (io::is_sweep(path)) return {path, being_written, io::read_sweep(path)};
    if (io::is_ensemble(path)) return {path, being_written, io::read_ensemble_info(path)};
    if (io::is_path(path)) return {path, being_written, io::read_path(path)};
    if (io::is_modes(path)) return {path, being_written, io::read_modes(path)};
  }
  return {path, being_written,
          being_written == false ? io::read_info(path) : read_beside_writer(path)};
}

}  // namespace cayspin::program
