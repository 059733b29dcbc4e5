// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "simulation/plan.hpp"

#include <cayspin/io/trajectory.hpp>

#include <filesystem>

namespace cayspin::program {

using namespace simulation;

/// The last frame of a trajectory file, from which a run of a scene goes on.
class Restart {
 public:
  /// Throws UsageError when it is not a state of this scene: another lattice or precision, a time
  /// that is not that of its step, or no step left.
  Restart(std::filesystem::path path, io::Scene const& scene, Precision precision);

  std::filesystem::path const& path() const { return path_; }
  std::int64_t step() const { return info_.frame_steps.back(); }
  /// As io::read_spins gives them: bits are kept.
  std::vector<double> spins() const;

 private:
  std::filesystem::path path_;
  io::TrajectoryInfo info_;
};

}  // namespace cayspin::program
