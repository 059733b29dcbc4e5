// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/site_box.hpp"
#include "io/stage.hpp"

#include <cayspin/checkpoint.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

/// The file from which a run is continued (HDF5; docs/reference/file_format.md has the layout).
/// Failures to read or write throw std::runtime_error with one line: the file, the action that
/// failed, and why. Wrong arguments throw std::invalid_argument, calls in a wrong order
/// std::logic_error.
namespace cayspin::inline v0_2::io {

/// The run that a checkpoint belongs to, and its progress.
struct CheckpointHeader {
  std::string scene_text, resolved_scene;  ///< as in TrajectoryHeader
  std::string cayspin_version;
  std::string precision = "double";            ///< "single" or "double", for the run and the fields
  std::array<std::int64_t, 3> shape{1, 1, 1};  ///< nx, ny, nz, as in TrajectoryHeader
  std::int64_t cell_sites = 1;
  std::int64_t step = 0;
  double time = 0;        ///< in the scene's units
  bool si = false;        ///< true if the scene is in SI
  StageBegin stage = {};  ///< start of the current stage
};

/// Returns the name of a trajectory's checkpoint: "run.checkpoint.h5" for "run.h5", and
/// "run_0.5.checkpoint.h5" for "run_0.5".
std::filesystem::path checkpoint_beside(std::filesystem::path trajectory);

/// Writer of PATH.partial, which commit() renames to PATH.
class CheckpointWriter final : public Checkpoint {
 public:
  CheckpointWriter(std::filesystem::path path, CheckpointHeader const& header);
  /// Removes PATH.partial unless commit() has renamed it.
  ~CheckpointWriter() override;
  CheckpointWriter(CheckpointWriter const&) = delete;
  CheckpointWriter& operator=(CheckpointWriter const&) = delete;

  bool restores() const override { return false; }
  void number(std::string const& name, double& value) override;
  void field(std::string const& name, std::vector<double>& numbers) override;
  /// Stores the next planes along z of a field with `components` numbers per site. Call it until
  /// all planes of the field are stored.
  void planes(std::string const& name, std::int64_t components, std::vector<double> const& numbers);

  /// Waits until the file is on the disk, then renames it. The field "spins" must have been stored.
  void commit();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Reader of a checkpoint. The constructor verifies each field by the field's checksum, and all
/// other contents by the checksum of the file. Files of earlier versions lack that checksum, or it
/// does not cover the shape.
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
  /// Returns a field's numbers at the sites of a box. Needs memory for these numbers and for some
  /// planes of the field.
  std::vector<double> field(std::string const& name, SiteBox const& box) const;

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Returns true for an HDF5 file that is marked as a checkpoint.
bool is_checkpoint(std::filesystem::path const& path);

}  // namespace cayspin::inline v0_2::io
