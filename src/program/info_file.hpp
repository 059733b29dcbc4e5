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

/// Contents of a file for `cayspin info`: everything but the arrays with values per site.
struct InfoFile {
  std::filesystem::path path;
  std::optional<bool> being_written;  ///< from io::is_being_written, before the file was read
  std::variant<io::TrajectoryInfo, io::SweepInfo, io::EnsembleInfo, io::Path, io::BandsContents>
      contents;
};

/// Reads a file that cayspin wrote, of any kind. Those of runs and ensembles can be read while
/// they are written. Throws std::runtime_error with a one-line message.
InfoFile read_info_file(std::filesystem::path const& path);

/// Returns the contents as one object. Values that are in the file have the names of their
/// attributes and datasets as keys.
Json as_json(InfoFile const& file);

}  // namespace cayspin::program
