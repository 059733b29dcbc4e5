// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/ensemble_file.hpp"
#include "io/scene.hpp"

#include <algorithm>
#include <cstdint>
#include <optional>

namespace cayspin::simulation {

/// The replicas of an ensemble that one process runs.
struct ReplicaShare {
  io::ReplicaRange own;
  /// How many replicas all processes on this machine run.
  std::int64_t on_this_machine = 0;
  /// Memory available to them all, before any was opened; empty: look now.
  std::optional<std::int64_t> available = {};
};

/// Returns the share of a process that runs all replicas.
inline ReplicaShare all_replicas(io::Scene const& scene) {
  auto const replicas = scene.ensemble.replicas;
  return {{0, replicas}, replicas, {}};
}

/// Returns the share of one of `ranks` processes, `ranks_here` of which are on its machine. Shares
/// differ by at most one replica.
inline ReplicaShare share_of_rank(io::Scene const& scene, int rank, int ranks, int ranks_here) {
  auto const replicas = scene.ensemble.replicas;
  auto const begin_of = [&](std::int64_t number) { return replicas * number / ranks; };
  auto const first = begin_of(rank), count = begin_of(rank + 1) - first;
  auto const most = (replicas + ranks - 1) / ranks;
  return {{first, count}, std::min(replicas, most * ranks_here), {}};
}

}  // namespace cayspin::simulation
