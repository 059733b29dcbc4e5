// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "plan.hpp"
#include "scene_field.hpp"

#include <cayspin/minimize.hpp>

namespace cayspin::simulation {

/// Throws io::SceneError for scenes without equilibria: rigid bodies, and spins at a temperature.
void require_rest(io::Scene const& scene);

/// Plans a search for the equilibria of a scene: its memory, and a frame for each. Throws like
/// require_rest and make_plan.
Plan make_plan_to_relax(io::Scene const& scene, Precision precision);

/// Search for equilibria of the fields of a scene. Reuses its memory.
template <class Real, class Space>
class SceneMinimizer {
 public:
  using Spins = SpinField<Real, typename Space::memory_space>;

  explicit SceneMinimizer(Spins const& like) : minimizer_(like) {}

  /// Calls cayspin::minimize, in reduced units, where the field is -dE/dm: H times the moment.
  /// Throws NumbersFailed for a field that is not finite.
  Minimum minimize(Space const& exec, io::Scene const& scene, SceneField<Spins> const& field,
                   Spins& spins, MinimizeOptions const& options);

  /// Like minimize, but options.torque and Minimum::torque are max |m x H|. Where a moment is not
  /// 1, it repeats the search with other bounds until that is below options.torque.
  Minimum relax(Space const& exec, io::Scene const& scene, SceneField<Spins> const& field,
                Spins& spins, MinimizeOptions const& options);

 private:
  Minimizer<Spins> minimizer_;
};

}  // namespace cayspin::simulation
