// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "command.hpp"
#include "run_stages.hpp"

namespace cayspin::program {

/// Performs `cayspin run` for a scene with [ensemble], whose replicas are divided among the ranks.
/// Returns the exit status.
int run_ensemble(io::Scene const& scene, RunOptions const& options, Ranks& ranks);

/// How `cayspin relax` searches for the equilibrium of each replica.
struct RelaxEnsembleOptions {
  double torque = 1e-6;
  std::int64_t evaluations = 100000;
  bool keep_saddles = false, quiet = false, json = false;
};

/// Performs `cayspin relax` for a scene with [ensemble], whose replicas are divided among the
/// ranks: moves each replica to its own equilibrium. Returns the exit status.
int relax_ensemble(io::Scene const& scene, DeviceOptions const& options,
                   RelaxEnsembleOptions const& search, Ranks& ranks);

}  // namespace cayspin::program
