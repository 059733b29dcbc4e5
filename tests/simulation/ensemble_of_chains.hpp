// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "scenes_of_text.hpp"
#include "simulation/ensemble_run.hpp"

#include <string>

namespace cayspin::simulation::test {

inline std::string const chains = R"([lattice]
shape = [6]
[field]
exchange = 1.0
applied = [0.3, "0.1*t", 0]
[initial]
random = { seed = 7 }
[ensemble]
replicas = 40
)";
inline std::string const noise = "[thermal]\ntemperature = 0.1\nseed = 3\n";

/// Returns true if the replicas of a scene are stepped as columns.
inline bool are_columns(io::Scene const& scene) {
  return ReplicaColumns::open(scene, io::replica_of(scene, 0), {}, all_replicas(scene)).has_value();
}

}  // namespace cayspin::simulation::test
