// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble_checkpoint.hpp"
#include "io/run_output.hpp"
#include "simulation/ensemble_run.hpp"
#include "simulation/ranks.hpp"

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace cayspin::program {

using namespace simulation;

/// An ensemble whose replicas are divided among ranks: each rank runs an equal share, or one more.
/// All ranks must call the same members in the same order, except own(). If a call fails on one
/// rank, it throws on all, as Ranks::together does.
class EnsembleOnRanks {
 public:
  /// Opens each rank's share as EnsembleRun does.
  EnsembleOnRanks(io::Scene const& scene, RunSettings const& settings, bool relaxes, Ranks& ranks);

  /// Returns this rank's share of the replicas.
  EnsembleRun const& own() const { return *own_; }

  /// Continues as EnsembleRun does; the first rank returns the warning.
  std::optional<std::string> continue_from(std::filesystem::path const& file);
  /// Returns the warning of EnsembleRun on the first rank whose replicas have one.
  std::optional<std::string> warning();

  // Like those of EnsembleRun, for the replicas of all ranks.
  std::int64_t steps() const { return steps_; }
  std::int64_t last_step() const { return last_step_; }
  std::int64_t furthest() const { return -ranks_.lowest(-own_->furthest()); }
  double time() const { return own_->first().time_at(steps_); }  // on the first rank
  /// Advances all replicas to step `target`.
  Advanced advance(std::int64_t target, Looks const& looks);

  bool remembers() const { return own_->remembers(); }
  /// Stores a checkpoint, which the first rank writes.
  void store(std::filesystem::path const& path, io::CheckpointHeader const& header);

  /// Return nothing on ranks but the first.
  std::vector<Minimum> relax(RelaxSettings const& settings);
  std::vector<io::Scalars> scalars();
  std::vector<std::byte> spins();

  /// Returns the cost of all ranks, on the first.
  io::RunCost cost(double wall_seconds) const;

 private:
  Ranks& ranks_;
  std::int64_t available_;  // memory, in bytes
  std::unique_ptr<EnsembleRun> own_;
  std::int64_t replicas_, steps_ = 0, last_step_;
};

}  // namespace cayspin::program
