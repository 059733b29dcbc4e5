// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/checkpoint.hpp"
#include "io/ensemble_file.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

/// The file from which an ensemble is continued (HDF5; docs/reference/file_format.md has the
/// layout). Errors are those of CheckpointWriter and CheckpointReader.
namespace cayspin::inline v0_2::io {

/// State from which a replica continues exactly.
class ReplicaState final : public Checkpoint {
 public:
  std::int64_t step = 0;
  bool has_ended = false;  ///< ended early, by until_torque
  std::map<std::string, double> numbers;
  std::map<std::string, std::vector<double>> fields;  ///< "spins" is one of them

  /// Ends storing: later calls of the members below restore values.
  void close() { restores_ = true; }

  bool restores() const override { return restores_; }
  /// While restoring, number() and field() throw std::runtime_error for a name that was not stored,
  /// except that number() keeps a value of the guard. A column of ReplicaColumns has none.
  void number(std::string const& name, double& value) override;
  void field(std::string const& name, std::vector<double>& values) override;

  static bool is_of_guard(std::string const& name) { return name.starts_with("guard."); }

 private:
  bool restores_ = false;
};

/// Returns a replica's state as bytes, of which there is an even number.
std::vector<std::byte> state_bytes(ReplicaState const& state);

/// The number of a replica, and how many bytes its state has.
struct PackedReplica {
  std::int64_t number = 0, bytes = 0;
};

/// Writer of PATH.partial, which commit() renames to PATH.
class EnsembleCheckpointWriter {
 public:
  /// `header`: that of one replica, with the step and time of the ensemble and its whole scene.
  EnsembleCheckpointWriter(std::filesystem::path path, CheckpointHeader const& header,
                           std::int64_t replicas);
  /// Removes PATH.partial unless commit() has renamed it.
  ~EnsembleCheckpointWriter();
  EnsembleCheckpointWriter(EnsembleCheckpointWriter&&) noexcept;

  /// Stores the states of some replicas, in any order; `states`: their bytes, one after the other.
  void add(std::vector<PackedReplica> const& replicas, std::vector<std::byte> const& states);

  /// Waits until the file is on the disk, then renames it. All replicas must have been stored.
  void commit();

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

/// Contents of an ensemble's checkpoint except the states.
struct EnsembleCheckpointInfo {
  CheckpointHeader header;
  /// Where the state of each replica begins and ends in /state, and its checksum.
  std::vector<std::int64_t> begins, ends, checksums;

  std::int64_t replicas() const { return std::ssize(begins); }
};

/// Returns true for an HDF5 file that is marked as the checkpoint of an ensemble.
bool is_ensemble_checkpoint(std::filesystem::path const& path);
/// Verifies the checksum of everything but the states.
EnsembleCheckpointInfo read_ensemble_checkpoint(std::filesystem::path const& path);
/// Reads the states of these replicas, to restore from, and verifies their checksums.
std::vector<ReplicaState> read_replica_states(std::filesystem::path const& path,
                                              EnsembleCheckpointInfo const& info,
                                              ReplicaRange const& replicas);

}  // namespace cayspin::inline v0_2::io
