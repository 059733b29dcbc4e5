// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "io/key.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace cayspin::inline v0_2::io {

struct Field;
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
  std::string text_of_replicas;  ///< the scene's text without [ensemble], a table that may be long

  bool there() const { return replicas > 0; }
};

/// Set for a lattice whose columns (the sites with equal x) are replicas that do not interact
/// (simulation/replica_columns.hpp). Reading a scene never sets Scene::columns.
struct Columns {
  std::vector<double> temperatures;  ///< factors on the temperature, one per column; empty: all 1
  std::vector<double> dampings;      ///< replace system.damping, one per column; empty: all have it
  std::vector<Triple> applied;       ///< replace field.applied, one per column; empty: all have it
  /// Replace the constants of field.anisotropies, as many numbers per column; empty: all have them.
  std::vector<std::vector<double>> constants;

  /// Returns the columns first .. first + count - 1.
  Columns part(std::int64_t first, std::int64_t count) const;
  /// Returns temperatures or, if dampings differ, damping * temperature of each column.
  std::vector<double> heats() const;
  /// Replaces the constants of field.anisotropies by those of a column.
  void put_constants(std::size_t column, Field& field) const;
  /// Replaces all values of a scene that differ between columns by those of a column.
  void put(std::size_t column, Scene& scene) const;
};

/// Returns the scene of one replica, without [ensemble]: the varied keys have the replica's values,
/// and `replica` is added to the seeds of noise and of random starts. Throws SceneError.
Scene replica_of(Scene const& scene, std::int64_t replica);
/// Like replica_of, for a scene of `cayspin relax`.
Scene replica_to_relax(Scene const& scene, std::int64_t replica);
/// Returns the values of the varied keys in the replicas first .. first + count - 1: bitwise those
/// of replica_of, but without reading a scene for each replica. `one`: the scene of any replica.
/// Temperatures are in reduced units; they are set if temperatures vary, and also if dampings vary
/// at a temperature. Returns nothing if a key other than thermal.temperature, the damping, a
/// component of field.applied or a constant of a uniaxial anisotropy varies, if a unit differs
/// between the replicas, if an applied field that varies depends on t, or if replica_of might
/// refuse a value.
std::optional<Columns> values_of_replicas(Scene const& scene, Scene const& one, std::int64_t first,
                                          std::int64_t count);

/// Throws SceneError for an ensemble. `who`: the command or function that accepts no ensemble, for
/// the message.
void require_no_ensemble(Scene const& scene, std::string_view who);

}  // namespace cayspin::inline v0_2::io
