// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/site_box.hpp"
#include "io/stage.hpp"
#include "io/units.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// The trajectory file of a run (HDF5; docs/reference/file_format.md has the layout).
///
/// Every failure of the file system or of HDF5 throws std::runtime_error with one line: the file,
/// the action that failed, and why. HDF5 itself prints nothing. Not thread-safe. If this is a
/// program's first use of HDF5, HDF5's clean-up at exit is turned off, so that HDF5 does not close
/// files that other code has left open.
namespace cayspin::inline v0_2::io {

/// Optional numbers of each sample, which follow its Scalars in this order.
struct MoreScalars {
  std::int64_t regions = 0;  ///< number of regions; all magnetizations come before all energies
  std::vector<std::string> terms = {};  ///< energies of the terms with these names
  bool shift = false;  ///< number of cells by which the lattice has moved; also in frames
  bool stage = false;  ///< number of the stage; only in frames

  std::size_t count() const {
    return 4 * static_cast<std::size_t>(regions) + terms.size() + (shift ? 1 : 0) + (stage ? 1 : 0);
  }
};

/// Optional numbers of a frame, as listed in MoreScalars.
struct FrameNumbers {
  std::int64_t shift = 0, stage = 0;
};

/// Metadata of the run that writes a trajectory file.
struct TrajectoryHeader {
  std::string scene_text;      ///< the scene as run, command line overrides applied
  std::string resolved_scene;  ///< for method "auto": with the chosen method; otherwise empty
  std::string cayspin_version;
  std::string git_commit;
  std::string kokkos_version;
  std::string space;                 ///< name of the execution space
  std::string precision = "double";  ///< "single" or "double", for the run and for /spins
  int threads = 1;
  /// nx, ny, nz. For a crystal nz is cell_sites times the number of cells along z: plane k *
  /// cell_sites + s has site s of the cells with number k along z.
  std::array<std::int64_t, 3> shape{1, 1, 1};
  std::int64_t cell_sites = 1;  ///< sites of a cell
  Units units;                  ///< of the times and energies in the file
  bool relaxes = false;   ///< true for a search for an equilibrium, which sets RunCost::relaxed
  MoreScalars more = {};  ///< optional numbers of samples; `stage` is not one of them
  std::optional<StageBegin> stage = {};  ///< for a run in stages: the stage of the first frame
};

/// Storage layout of /spins.
struct TrajectoryStorage {
  int compression = 0;     ///< level of deflate with shuffle, 0 (none) to 9
  std::int64_t chunk = 0;  ///< planes along z in a chunk; 0: all, or as many as 256 MiB hold
  /// Number of planned frames. A kill loses no frame in the first 8180 chunks, so uncompressed
  /// chunks hold several frames if the planned ones would need more chunks than that.
  std::int64_t frames = 0;
  bool sync = false;  ///< a power cut loses at most the frame being written
};

/// Division of a frame into pieces along z for writing. Each piece has `planes` planes, but the
/// last may have fewer.
struct FramePieces {
  std::int64_t planes = 0;
  std::size_t bytes = 0;   ///< memory for a piece
  std::size_t copied = 0;  ///< bytes of the copies made while a piece is written
};

/// Returns pieces of whole chunks with at most `most_planes` planes (0: all), but at least one
/// chunk, for a lattice (nx, ny, nz) and numbers of 4 or 8 bytes. A frame of a crystal with several
/// sites per cell is a single piece.
FramePieces frame_pieces(std::array<std::int64_t, 3> const& shape, std::size_t number_bytes,
                         TrajectoryStorage const& storage, std::int64_t most_planes = 0,
                         std::int64_t cell_sites = 1);

/// The observables at one time, always in double.
struct Scalars {
  double energy = 0;                      ///< summed over the sites: reduced, or in J
  double norm_defect = 0;                 ///< max | |m| - 1 | over the sites
  std::array<double, 3> magnetization{};  ///< mean of m, weighted by the moments of the sites
};

/// The observables after a step.
struct Sample {
  std::int64_t step = 0;
  double time = 0;
  Scalars scalars = {};
};

/// Calls visit(name, member) for each of the scalars, by the names of their datasets.
template <class Visit>
void for_each_scalar(Visit const& visit) {
  visit("energy", &Scalars::energy);
  visit("norm_defect", &Scalars::norm_defect);
  visit("magnetization", &Scalars::magnetization);
}

/// Result of `cayspin relax`.
struct Relaxed {
  double torque = 0;       ///< largest max |m x H| of the frames: reduced, or mu0 H in T
  bool converged = false;  ///< true if each frame is a minimum, within the bound on the torque
};

/// Cost of a run, known at its end.
struct RunCost {
  std::int64_t evaluations = 0;  ///< evaluations of the generator over all sites
  double wall_seconds = 0;       ///< of the whole run
  double step_seconds = 0;       ///< of the steps, without observers and writing
  std::optional<Relaxed> relaxed = {};
};

/// Writer of one run. The file is readable after every write_frame, even if the writer is killed:
/// it then holds whole frames and `complete` = 0. With TrajectoryStorage::sync this also holds
/// after a power cut.
class TrajectoryFile {
 public:
  /// Creates the file with everything but frames. Without `overwrite`, an existing file is an
  /// error. With it, the new file replaces the old one once its header is written; until then, it
  /// is called PATH.partial. A failed creation changes no existing file and leaves no new one.
  /// `positions`: x, y and z of each site, in the order of the sites in the file; or empty.
  /// `before_named`: called before the new file takes its name; if it throws, the creation fails.
  /// Throws std::invalid_argument for a wrong header, storage or number of positions.
  TrajectoryFile(std::filesystem::path path, TrajectoryHeader const& header, bool overwrite,
                 TrajectoryStorage const& storage = {}, std::vector<double> const& positions = {},
                 std::function<void()> const& before_named = {});

  /// Closes the file. Unless finish() was called, it stays marked as not complete.
  ~TrajectoryFile();
  TrajectoryFile(TrajectoryFile&&) noexcept;
  TrajectoryFile& operator=(TrajectoryFile&&) noexcept;

  /// Appends one frame and its scalars, and flushes. `spins` is packed as (nz, ny, nx, 3), in the
  /// precision of the header; the other precision throws std::logic_error.
  void write_frame(std::int64_t step, double time, Scalars const& scalars, float const* spins);
  void write_frame(std::int64_t step, double time, Scalars const& scalars, double const* spins);

  /// Appends a frame in pieces along z, in the precision of the header: call write_planes() with as
  /// many planes at a time as frame_pieces() says, then with the remaining planes, then
  /// end_frame(). `spins` must have room for a piece and may be overwritten. Other numbers of
  /// planes throw std::logic_error.
  void write_planes(std::int64_t planes, std::byte* spins);
  void end_frame(std::int64_t step, double time, Scalars const& scalars,
                 FrameNumbers const& numbers = {});

  /// Appends one sample to /scalars. It reaches the file with the next frame or, if more samples
  /// follow, within about a second. A wrong count of `more` throws std::logic_error.
  void write_scalars(std::int64_t step, double time, Scalars const& scalars,
                     std::vector<double> const& more = {});

  /// Ends the file of a run that went as planned: sets `complete` = 1 after everything else is in
  /// the file.
  void finish(RunCost const& cost);

  /// Ends the file of a run that was interrupted or failed: like finish(), but `complete` stays 0.
  void close(RunCost const& cost);

  std::int64_t frames() const;  ///< frames written so far
  std::filesystem::path const& path() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Contents of a trajectory file, except its spins.
struct TrajectoryInfo {
  std::filesystem::path path;
  int format = 0;
  TrajectoryHeader header;
  RunCost cost;
  bool complete = false;
  std::int64_t frames = 0;  ///< whole frames
  std::vector<std::int64_t> frame_steps;
  std::vector<double> frame_times;
  std::vector<Scalars> frame_scalars;
  /// For crystals with several sites per cell, cell_sites entries for each frame. Entry s is the
  /// mean of m over the sites s of all cells that have a spin; zero if none has.
  std::vector<std::array<double, 3>> frame_sublattices;
  std::vector<std::int64_t> frame_shifts;  ///< for scenes with lattice.follow
  std::vector<std::int64_t> frame_stages;  ///< for a run in stages
  std::int64_t samples = 0;                ///< length of /scalars
  /// The last sample of /scalars, if the run is not complete or the samples have more than Scalars.
  std::optional<Sample> last_sample = {};
  std::vector<double> more_of_last_sample = {};  ///< as listed in header.more
};

/// After a kill or a power cut, completes a file that was written with TrajectoryStorage::sync.
/// Call it before another program reads the file; the functions below do it themselves. Leaves any
/// other file unchanged.
void complete_file(std::filesystem::path const& path);

/// Returns what kind of file of cayspin it is, as in "the file of a sweep"; empty for a trajectory
/// file and for files of other programs.
std::string kind_of_other_file(std::filesystem::path const& path);

/// Reads everything except the spins of a trajectory file.
TrajectoryInfo read_info(std::filesystem::path const& path);

/// Reads a file that another process is writing. Takes no lock and writes nothing, so the writer
/// does not notice. Ignores half-written samples. Throws std::runtime_error for an inconsistent
/// state; a later call may succeed.
TrajectoryInfo read_info_while_written(std::filesystem::path const& path);

/// Returns true if a process has the file open for writing; nothing if that cannot be found out,
/// because files are not locked or this one cannot be opened.
std::optional<bool> is_being_written(std::filesystem::path const& path);

/// For `cell_sites`: accepts any number of sites per cell in the file that fits the lattice.
inline constexpr std::int64_t any_cell_sites = 0;

/// Reads dataset /spins of any HDF5 file for a lattice (nx, ny, nz): a state (nz, ny, nx, 3), or
/// the last of the frames (frame, nz, ny, nx, 3), or the last whole frame of a trajectory file. For
/// a crystal, frames may also be stored as (frame, cell_sites, nz / cell_sites, ny, nx, 3). The
/// stored type is float or double, and numbers are not rounded. The result is packed as (nz, ny,
/// nx, 3), in the order of TrajectoryHeader::shape.
std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape);

/// Reads the spins of the sites in a box. Needs memory for them, and for a chunk or some planes.
std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, SiteBox const& box,
                               std::int64_t cell_sites = any_cell_sites);

/// Reads the spins of frame number `frame`, counted from 0, of a file with frames.
std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, std::int64_t frame,
                               std::int64_t cell_sites = any_cell_sites);

}  // namespace cayspin::inline v0_2::io
