// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/site_box.hpp"

#include <cayspin/checkpoint.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/// The file that a run is continued from (HDF5, laid out as docs/reference/file_format.md says).
/// Failures throw std::runtime_error with one line: the file, what could not be done, and why.
namespace cayspin::inline v0_1::io {

/// Of which run, and where it stands.
struct CheckpointHeader {
  std::string scene_text, resolved_scene;  ///< as in TrajectoryHeader
  std::string cayspin_version;
  std::string precision = "double";            ///< of the run and of the fields: "single", "double"
  std::array<std::int64_t, 3> shape{1, 1, 1};  ///< nx, ny, nz, as in TrajectoryHeader
  std::int64_t cell_sites = 1;
  std::int64_t step = 0;
  double time = 0;  ///< in the scene's units
  bool si = false;  ///< are they SI?
};

/// "run.checkpoint.h5" for "run.h5"
std::filesystem::path checkpoint_beside(std::filesystem::path trajectory);

/// Writes PATH.partial, which takes the place of what is at PATH when commit() says so.
class CheckpointWriter final : public Checkpoint {
 public:
  CheckpointWriter(std::filesystem::path path, CheckpointHeader const& header);
  /// Uncommitted: removes what was written.
  ~CheckpointWriter() override;
  CheckpointWriter(CheckpointWriter const&) = delete;
  CheckpointWriter& operator=(CheckpointWriter const&) = delete;

  bool restores() const override { return false; }
  void number(std::string const& name, double& value) override;
  void field(std::string const& name, std::vector<double>& numbers) override;
  /// The same by planes along z, one call after the other: `components` numbers of each site.
  void planes(std::string const& name, std::int64_t components, std::vector<double> const& numbers);

  /// Waits until the file is on the disk, then gives it its name.
  void commit();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Reads a checkpoint. Each field is held against its checksum, and all else against that of the
/// file, which those of earlier versions do not have.
class CheckpointReader final : public Checkpoint {
 public:
  explicit CheckpointReader(std::filesystem::path path);
  ~CheckpointReader() override;
  CheckpointReader(CheckpointReader const&) = delete;
  CheckpointReader& operator=(CheckpointReader const&) = delete;

  CheckpointHeader const& header() const;
  std::filesystem::path const& path() const;

  bool restores() const override { return true; }
  void number(std::string const& name, double& value) override;
  void field(std::string const& name, std::vector<double>& numbers) override;
  /// The numbers of these sites alone. Memory is taken for them, and for some planes.
  std::vector<double> field(std::string const& name, SiteBox const& box) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Is this an HDF5 file that says it is a checkpoint?
bool is_checkpoint(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_1::io
