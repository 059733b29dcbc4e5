// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "plan.hpp"
#include "scene_field.hpp"

#include <cayspin/minimize.hpp>

namespace cayspin::simulation {

/// Throws io::SceneError for what has no state of rest: rigid bodies, and spins at a temperature.
void require_rest(io::Scene const& scene);

/// The plan of a search for the states of rest of a scene: memory of the search, a frame for each.
/// Throws as require_rest and make_plan do.
Plan make_plan_to_relax(io::Scene const& scene, Precision precision);

/// Finds states of rest of the fields of a scene. Keeps its memory from one to the next.
template <class Real, class Space>
class SceneMinimizer {
 public:
  using Spins = SpinField<Real, typename Space::memory_space>;

  explicit SceneMinimizer(Spins const& like) : minimizer_(like) {}

  /// As cayspin::minimize, in reduced numbers. Throws NumbersFailed for a field that is not finite.
  Minimum minimize(Space const& exec, io::Scene const& scene, SceneField<Spins> const& field,
                   Spins& spins, MinimizeOptions const& options);

 private:
  Minimizer<Spins> minimizer_;
};

}  // namespace cayspin::simulation
