// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <string>
#include <vector>

/// The file of a sweep: one scene run with every combination of the values of some keys. It is
/// laid out as docs/reference/file_format.md says. Errors are those of trajectory.hpp.
namespace cayspin::inline v0_1::io {

/// A key of a scene and the values that it takes.
struct SweptKey {
  std::string key;                  ///< "system.damping"
  std::vector<std::string> values;  ///< TOML, as typed
  std::vector<double> numbers;      ///< the same as numbers; empty unless all of them are
};

/// Reads "key=a,b,c". A comma inside brackets, braces or quotes does not separate. Throws
/// SceneError.
SweptKey read_swept_key(std::string const& assignment);

/// What makes two sweeps the same.
struct SweepHeader {
  std::string scene_text;  ///< of the first run
  std::vector<SweptKey> keys;
  std::string precision, space;
  std::string cayspin_version, git_commit;  ///< may differ in the same sweep

  /// Runs of the full grid; those of the last key's values follow each other.
  std::int64_t runs() const;
  /// Which value of each key a run has.
  std::vector<std::size_t> indices(std::int64_t run) const;
  /// "key=value" for each key, as overrides of the scene.
  std::vector<std::string> overrides(std::int64_t run) const;
};

/// What became of a run.
struct SweptRun {
  static constexpr std::int64_t not_run = -1;

  std::int64_t status = not_run;  ///< its exit status
  std::string message;            ///< what it said on standard error
  std::int64_t step = 0;          ///< the last one in its file
  double time = std::numeric_limits<double>::quiet_NaN();
  Scalars scalars{time, time, {time, time, time}};  ///< of the last frame
  RunCost cost;
  bool has_file = false;  ///< a file with a frame
};

/// A sweep as its file has it.
struct SweepInfo {
  SweepHeader header;
  std::vector<SweptRun> runs;
  bool complete = false;  ///< every run has ended as planned or by its numbers
  bool one_file = false;  ///< the runs are in the file itself
};

/// The folder of the runs' own files until they are taken into the file of the sweep.
std::filesystem::path sweep_folder(std::filesystem::path const& file);
/// The name of a run: its group in the file of the sweep, and its own file without extension.
std::string swept_run_name(std::int64_t run);
/// A run's own file.
std::filesystem::path swept_run_file(std::filesystem::path const& file, std::int64_t run);

/// Writes PATH.partial and renames it: at every moment there is a whole file. With `one_file` the
/// runs' own files are copied into it, otherwise it links to them. A file that is damaged is
/// refused with its name. `go_on` is asked before each copy; returns false with the old file in
/// place when it says no.
bool write_sweep(std::filesystem::path const& path, SweepInfo const& sweep,
                 std::function<bool()> const& go_on = {});

/// Is it an HDF5 file with a sweep?
bool is_sweep(std::filesystem::path const& path);
/// Reads all but the runs' trajectories. Throws std::runtime_error with one line.
SweepInfo read_sweep(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_1::io
