// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble_file.hpp"
#include "io/modes.hpp"
#include "io/path.hpp"
#include "io/sweep.hpp"
#include "io/trajectory.hpp"
#include "print_json.hpp"

#include <filesystem>
#include <optional>
#include <variant>

namespace cayspin::program {

/// Contents of a file for `cayspin info`: everything but its spins.
struct InfoFile {
  std::filesystem::path path;
  std::optional<bool> being_written;  ///< by io::is_being_written, before the file was read
  std::variant<io::TrajectoryInfo, io::SweepInfo, io::EnsembleInfo, io::Path, io::BandsContents>
      contents;
};

/// Reads a file of any kind, and a trajectory also while a run writes it. Throws std::runtime_error
/// with one line.
InfoFile read_info_file(std::filesystem::path const& path);

/// Returns the numbers of a file by the names of its attributes and datasets.
Json as_json(InfoFile const& file);

}  // namespace cayspin::program
