// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2::io {

struct Scene;

/// A key of the scene with one value for each replica, in the units of the scene.
struct VariedKey {
  std::string key;
  std::vector<double> values;
};

/// The table [ensemble]: independent copies of the lattice in one run.
struct Ensemble {
  std::int64_t replicas = 0;  ///< 0: the scene has no such table
  std::vector<VariedKey> vary;
  std::string text_of_replicas;  ///< the scene without [ensemble], whose lists may be long

  bool there() const { return replicas > 0; }
};

/// A lattice whose columns, the sites with equal x, are replicas that do not interact
/// (simulation/replica_columns.hpp). No file has such a scene.
struct Columns {
  std::vector<double> temperatures;  ///< multiply that of the scene; empty: all 1
};

/// The scene of one replica, which has no [ensemble]: its values of the varied keys, and the seeds
/// of noise and random starts plus `replica`. Throws SceneError.
Scene replica_of(Scene const& scene, std::int64_t replica);
/// As replica_of, of a scene for `cayspin relax`.
Scene replica_to_relax(Scene const& scene, std::int64_t replica);

/// Throws SceneError for an ensemble. `who`: what takes none, as the message names it.
void require_no_ensemble(Scene const& scene, std::string_view who);

}  // namespace cayspin::inline v0_2::io
