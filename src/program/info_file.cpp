// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#include "info_file.hpp"

#include <chrono>
#include <stdexcept>
#include <thread>
#include <utility>

namespace cayspin::program {
namespace {

// Retries for about a second, because a half-written part may soon be complete.
InfoFile read_beside_writer(std::filesystem::path const& path, std::optional<bool> being_written) {
  for (int tries = 20;; --tries) {
    try {
      if (auto ensemble = io::read_ensemble_info_while_written(path))
        return {path, being_written, std::move(*ensemble)};
      return {path, being_written, io::read_info_while_written(path)};
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
  if (being_written == false) return {path, being_written, io::read_info(path)};
  return read_beside_writer(path, being_written);
}

}  // namespace cayspin::program
