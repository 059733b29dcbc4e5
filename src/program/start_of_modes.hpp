// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/scene.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program {

/// The scene of `cayspin modes`. Its start is the state at which the search begins.
struct StartOfModes {
  io::Scene scene;
  bool is_saddle = false;  ///< the start is a saddle of a path, which must not be relaxed
};

/// Reads the scene from a scene file, a trajectory file or the file of a path. `frame`: option
/// --frame, which chooses the state of a file. A scene with a list of fields gets the field of the
/// frame. Throws UsageError for a wrong --frame, and for the file of a path without it.
StartOfModes start_of_modes(std::filesystem::path const& file,
                            std::vector<std::string> const& overrides,
                            std::optional<std::string> const& frame);

/// Check the files of a scene that start_of_modes() read from `file`, and return the spins of its
/// start. If `file` is not a scene file, errors name it as it was typed.
void check_files(io::Scene const& scene, std::filesystem::path const& file);
std::vector<double> start_spins(io::Scene const& scene, std::filesystem::path const& file);

}  // namespace cayspin::program
