// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/site_box.hpp"
#include "io/units.hpp"

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

/// The trajectory file of a run (HDF5, laid out as docs/reference/file_format.md says).
///
/// Every failure of the file system or of HDF5 throws std::runtime_error whose message is one line:
/// the file, what could not be done, and why. HDF5 itself prints nothing. Not thread-safe.
/// Where this is a program's first use of HDF5, HDF5 does not close files of others at exit.
namespace cayspin::inline v0_1::io {

/// What a trajectory file says about the run that writes it.
struct TrajectoryHeader {
  std::string scene_text;      ///< the scene as run, command line overrides applied
  std::string resolved_scene;  ///< of method "auto": with the method it chose; otherwise empty
  std::string cayspin_version;
  std::string git_commit;
  std::string kokkos_version;
  std::string space;                 ///< name of the execution space
  std::string precision = "double";  ///< of the run and of /spins: "single" or "double"
  int threads = 1;
  /// nx, ny, nz. Of a crystal nz is cells times cell_sites: plane k * cell_sites + s has the sites
  /// s of the cells k.
  std::array<std::int64_t, 3> shape{1, 1, 1};
  std::int64_t cell_sites = 1;  ///< sites of a cell
  Units units;                  ///< of the times and energies in the file
  bool relaxes = false;         ///< it ends with RunCost::relaxed
};

/// How /spins lies in the file.
struct TrajectoryStorage {
  int compression = 0;      ///< level of deflate with shuffle, 0 (none) to 9
  std::int64_t chunk = 0;   ///< planes along z in a chunk; 0: the frame, or as many as 256 MiB hold
  std::int64_t frames = 0;  ///< that are planned; a kill loses none of them, or of 8180 chunks
  bool sync = false;        ///< a power cut loses at most the frame that is being written
};

/// How a frame goes into a file: by pieces of so many planes along z; the last may have fewer.
struct FramePieces {
  std::int64_t planes = 0;
  std::size_t bytes = 0;   ///< of room for a piece
  std::size_t copied = 0;  ///< bytes that HDF5 takes for copies
};

/// Pieces of whole chunks and at most so many planes (0: all), but of one chunk at least. For a
/// lattice (nx, ny, nz) and numbers of 4 or 8 bytes. A frame of a crystal with several sites in a
/// cell is one piece.
FramePieces frame_pieces(std::array<std::int64_t, 3> const& shape, std::size_t number_bytes,
                         TrajectoryStorage const& storage, std::int64_t most_planes = 0,
                         std::int64_t cell_sites = 1);

/// The observables of one instant, always in double.
struct Scalars {
  double energy = 0;                      ///< summed over the sites: reduced, or in J
  double norm_defect = 0;                 ///< max | |m| - 1 | over the sites
  std::array<double, 3> magnetization{};  ///< mean of m over the sites
};

/// The observables after a step.
struct Sample {
  std::int64_t step = 0;
  double time = 0;
  Scalars scalars = {};
};

/// visit(name, member) for each of the scalars, by the names of their datasets.
template <class Visit>
void for_each_scalar(Visit const& visit) {
  visit("energy", &Scalars::energy);
  visit("norm_defect", &Scalars::norm_defect);
  visit("magnetization", &Scalars::magnetization);
}

/// What `cayspin relax` came to.
struct Relaxed {
  double torque = 0;       ///< the largest max |m x H| of its frames: reduced, or mu0 H in T
  bool converged = false;  ///< each frame a minimum, to the bound on the torque
};

/// What a run cost, known once it has ended.
struct RunCost {
  std::int64_t evaluations = 0;  ///< evaluations of the generator over all sites
  double wall_seconds = 0;       ///< the whole run
  double step_seconds = 0;       ///< stepping alone: no observers, no writing
  std::optional<Relaxed> relaxed = {};
};

/// Writes one run. The file is readable after every write_frame, also by a reader that finds the
/// writer killed: it then holds whole frames and `complete` = 0. Where TrajectoryStorage::sync says
/// so, this holds after a power cut, too.
class TrajectoryFile {
 public:
  /// Creates the file with everything but frames. An existing file is an error unless `overwrite`;
  /// it is then replaced only once the new one stands beside it (as PATH.partial) with its header.
  /// A failed creation changes nothing that was there and leaves no new file. `positions` of the
  /// sites, three numbers each in the order of the file, or none.
  TrajectoryFile(std::filesystem::path path, TrajectoryHeader const& header, bool overwrite,
                 TrajectoryStorage const& storage = {}, std::vector<double> const& positions = {});

  /// Closes the file; without finish() before, it stays marked as not complete.
  ~TrajectoryFile();
  TrajectoryFile(TrajectoryFile&&) noexcept;
  TrajectoryFile& operator=(TrajectoryFile&&) noexcept;

  /// Appends one frame and its scalars, and flushes. `spins` is packed as (nz, ny, nx, 3), in the
  /// precision of the header; the other one throws std::logic_error.
  void write_frame(std::int64_t step, double time, Scalars const& scalars, float const* spins);
  void write_frame(std::int64_t step, double time, Scalars const& scalars, double const* spins);

  /// The same by planes along z, in the precision of the header: write_planes() for some after the
  /// other, so many at once as frame_pieces() says and at the end the rest, and then end_frame().
  /// `spins` has the room of a piece, which is used. Other numbers of planes throw
  /// std::logic_error.
  void write_planes(std::int64_t planes, std::byte* spins);
  void end_frame(std::int64_t step, double time, Scalars const& scalars);

  /// Appends one sample to /scalars; samples reach the file with the next frame, or within about a
  /// second of calls.
  void write_scalars(std::int64_t step, double time, Scalars const& scalars);

  /// Ends a run that went as planned: `complete` = 1, written after all else is in the file.
  void finish(RunCost const& cost);

  /// Ends a run that was interrupted or failed: the same, but `complete` stays 0.
  void close(RunCost const& cost);

  std::int64_t frames() const;  ///< frames written so far
  std::filesystem::path const& path() const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// What a trajectory file holds, without its spins.
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
  /// Of crystals with several sites in a cell, cell_sites entries for each frame: the mean of m
  /// over the sites s that have a spin; zero where none has.
  std::vector<std::array<double, 3>> frame_sublattices;
  std::int64_t samples = 0;                ///< length of /scalars
  std::optional<Sample> last_sample = {};  ///< where the run is not complete: the last of /scalars
};

/// Completes a file of TrajectoryStorage::sync after a kill or a power cut, for other readers than
/// those below, which do so themselves. Leaves any other file as it is.
void complete_file(std::filesystem::path const& path);

/// Reads all but the spins of a trajectory file.
TrajectoryInfo read_info(std::filesystem::path const& path);

/// Reads a file that another process writes: this takes no lock and writes nothing, so the
/// writer does not notice. Samples that are half written do not count. What cannot be read at one
/// moment throws std::runtime_error; a moment later it may be whole.
TrajectoryInfo read_info_while_written(std::filesystem::path const& path);

/// Does a process have the file open for writing? Unknown where files are not locked.
std::optional<bool> is_being_written(std::filesystem::path const& path);

/// Whatever the file has, where its sites fill the planes of the lattice.
inline constexpr std::int64_t any_cell_sites = 0;

/// Reads dataset /spins of any HDF5 file for a lattice (nx, ny, nz): (nz, ny, nx, 3), or the last
/// of (frame, nz, ny, nx, 3), of a trajectory file the last whole one. Of a crystal also
/// the last of (frame, cell_sites, nz / cell_sites, ny, nx, 3). Float or double, bits are kept; the
/// result is packed as (nz, ny, nx, 3), in the order of TrajectoryHeader::shape.
std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape);

/// The same for the sites of a box. Memory is taken for them, and for a chunk or some planes.
std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, SiteBox const& box,
                               std::int64_t cell_sites = any_cell_sites);

/// The same for frame number `frame`, counted from 0, of a file with frames.
std::vector<double> read_spins(std::filesystem::path const& path,
                               std::array<std::int64_t, 3> const& shape, std::int64_t frame,
                               std::int64_t cell_sites = any_cell_sites);

}  // namespace cayspin::inline v0_1::io
