// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "plan.hpp"
#include "scene_field.hpp"

#include <cayspin/minimize.hpp>

#include <vector>

namespace cayspin::simulation {

/// Throws io::SceneError for scenes without equilibria of an energy: rigid bodies, and spins with
/// torques or at a temperature.
void require_rest(io::Scene const& scene);

/// Plans a search for the equilibria of a scene: the memory, and one frame for each equilibrium.
/// Throws like require_rest and make_plan.
Plan make_plan_to_relax(io::Scene const& scene, Precision precision);

/// The smallest and the largest moment of sites with a spin.
struct MomentRange {
  double least = 1, largest = 1;
};
/// Takes the moments of io::all_moments. Returns 1 for both if they are empty or all 0.
MomentRange range_of_moments(std::vector<double> moments);

/// Searches for the equilibria of a scene in its fields, one after another, in the same memory.
template <class Real, class Space>
class SceneMinimizer {
 public:
  using Spins = SpinField<Real, typename Space::memory_space>;

  explicit SceneMinimizer(Spins const& like) : minimizer_(like) {}

  /// Searches for a minimum of the energy, in reduced units. `field` computes -dE/dm, which is H
  /// times the moment. Throws NumbersFailed for a field that is not finite.
  Minimum minimize(Space const& exec, io::Scene const& scene, SceneField<Spins> const& field,
                   Spins& spins, MinimizeOptions const& options);

  /// Like minimize, but options.torque is a bound on max |m x H|, and Minimum::torque is its value.
  /// If the scene has moments, repeats the search with smaller bounds, up to 20 times in all, until
  /// max |m x H| is at most options.torque.
  Minimum relax(Space const& exec, io::Scene const& scene, SceneField<Spins> const& field,
                Spins& spins, MinimizeOptions const& options);

 private:
  Minimizer<Spins> minimizer_;
};

}  // namespace cayspin::simulation
