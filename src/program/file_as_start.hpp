// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"
#include "io/toml_string.hpp"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

// Files that an option or argument names, and that become the start of a scene.
namespace cayspin::program {

/// Returns the override that makes the file the start.
inline std::string as_start(std::filesystem::path const& file) {
  return fmt::format("initial={{file={}}}",
                     io::toml_string(std::filesystem::absolute(file).string()));
}

/// If an error of a scene with as_start(file) is about the spins of the file, returns what is wrong
/// with them. The error itself also names a key and an option that nobody typed.
inline std::optional<std::string> fault_of_start(io::SceneError const& error,
                                                 std::filesystem::path const& file) {
  std::string_view text = error.what();
  auto const leave_out = [&](std::string const& words) {
    if (!text.starts_with(words)) return false;
    text.remove_prefix(words.size());
    return true;
  };
  auto const option = fmt::format("--set {}: ", as_start(file));
  if (!leave_out(option + "initial.file: ") && !leave_out(option + "initial.given: "))
    return std::nullopt;
  leave_out(std::filesystem::absolute(file).string() + ": ");
  return std::string(text);
}

}  // namespace cayspin::program
