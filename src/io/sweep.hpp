// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/trajectory.hpp"

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

/// The file of a sweep: one scene run with every combination of the values of some keys
/// (docs/reference/file_format.md has the layout). Errors are those of trajectory.hpp, unless a
/// comment says otherwise.
namespace cayspin::inline v0_2::io {

/// A key of a scene and its values.
struct SweptKey {
  std::string key;                  ///< such as "system.damping"
  std::vector<std::string> values;  ///< TOML, as typed, with quotes around words
  std::vector<double> numbers;      ///< the values as numbers; empty unless all are numbers
};

/// Reads "key=a,b,c". A comma inside brackets, braces or quotes does not separate. Words need no
/// quotes. Throws SceneError.
SweptKey read_swept_key(std::string const& assignment);

/// Scene, grid and origin of a sweep.
struct SweepHeader {
  std::string scene_text;  ///< of the first run
  std::vector<SweptKey> keys;
  std::string precision, space;
  std::string cayspin_version, git_commit;  ///< may differ within a sweep

  /// Returns the number of runs of the full grid. From run to run, the value of the last key
  /// changes fastest.
  std::int64_t runs() const;
  /// Returns the index of each key's value in a run.
  std::vector<std::size_t> indices(std::int64_t run) const;
  /// Returns "key=value" for each key, as overrides of the scene.
  std::vector<std::string> overrides(std::int64_t run) const;
};

/// Result of a run.
struct SweptRun {
  static constexpr std::int64_t not_run = -1;

  std::int64_t status = not_run;  ///< exit status of the run
  std::string message;            ///< what the run wrote on standard error
  std::int64_t step = 0;          ///< last step in its file
  double time = std::numeric_limits<double>::quiet_NaN();
  Scalars scalars{time, time, {time, time, time}};  ///< of the last frame
  RunCost cost;
  bool has_file = false;  ///< true if its file has a frame
  bool is_new = false;    ///< the run has just ended: its file is copied without being read first
};

/// Contents of a sweep's file.
struct SweepInfo {
  SweepHeader header;
  std::vector<SweptRun> runs;
  bool complete =
      false;  ///< every run has ended as planned, or because its values became non-finite
  bool one_file = false;  ///< the runs are in the file itself
};

/// Returns the folder of the runs' own files. With one file for all runs, it exists only until
/// these files are copied.
std::filesystem::path sweep_folder(std::filesystem::path const& file);
/// Returns the name of a run: its group in the file of the sweep, and its own file without
/// extension.
std::string swept_run_name(std::int64_t run);
/// Returns a run's own file.
std::filesystem::path swept_run_file(std::filesystem::path const& file, std::int64_t run);

/// Copies of runs that have ended, made while other runs of the sweep go on, in a file beside the
/// sweep's: FILE.runs.partial. write_sweep() turns it into the sweep's file.
class SweepCopies {
 public:
  explicit SweepCopies(std::filesystem::path file);
  /// Removes the file unless write_sweep() has taken it.
  ~SweepCopies();

  /// Removes the file that a killed sweep left. The sweep's own file has to be there.
  void remove_left() const;

  /// Copies the run's own file, which has just been written. Does nothing if the file is large, if
  /// the disk is nearly full, or after an error: write_sweep() then copies the run.
  void add(std::int64_t run);

 private:
  friend bool write_sweep(std::filesystem::path const& path, SweepInfo const& sweep,
                          std::function<bool()> const& go_on, SweepCopies* copies);
  class File;

  std::filesystem::path path_;
  std::unique_ptr<File> file_;
  bool failed_ = false;
};

/// Writes PATH.partial and renames it, so that PATH is never incomplete. With `one_file` the runs'
/// own files are copied into PATH, otherwise PATH links to them. Before copying, each file that is
/// not new is read once; if one is damaged, the error names it. Throws std::invalid_argument for
/// keys without values, and for a wrong number of runs or of a key's numbers. `go_on` is called
/// before each group of files; if it returns false, the old file stays, and write_sweep returns
/// false. `copies`: runs that are already copied; only with `one_file`.
bool write_sweep(std::filesystem::path const& path, SweepInfo const& sweep,
                 std::function<bool()> const& go_on = {}, SweepCopies* copies = nullptr);

/// Returns true for an HDF5 file with a sweep.
bool is_sweep(std::filesystem::path const& path);
/// Reads everything except the runs' trajectories. Throws std::runtime_error with one line.
SweepInfo read_sweep(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_2::io
