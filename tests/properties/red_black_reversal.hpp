// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "random_scene.hpp"

#include <cayspin/stepper/red_black.hpp>

#include <algorithm>
#include <cmath>

namespace cayspin::test {

/// Is there a checkerboard of two colours on it?
inline bool is_bipartite(Lattice const& lattice) {
  for (int axis = 0; axis < 3; ++axis)
    if (lattice.boundary[axis] == Boundary::periodic && lattice.shape[axis] > 1 &&
        lattice.shape[axis] % 2 != 0)
      return false;
  return true;
}

template <class Stepper>
double distance_after_return(RandomScene const& scene, double dt) {
  using Spins = typename Stepper::spins_type;
  auto const start = random_spins<Spins>(scene.slab.lattice, scene.start);
  auto const generator = scene.slab.natural();
  Spins spins = copy_of(start);
  Stepper stepper(spins);
  stepper.batch(Space{}, generator, spins, 0, dt, scene.steps);
  stepper.batch(Space{}, generator, spins, 0, -dt, scene.steps);
  return largest_distance(spins, start);
}

/// How far from its start a scene without damping is after as many red-black steps of -dt as of dt,
/// in units of what is allowed. The longest part of a step, 1.7 dt at order 4, stays where the
/// iteration for a spin's own terms settles.
template <class Real>
double red_black_reversal(RandomScene const& scene) {
  using Spins = SpinField<Real, Space::memory_space>;
  double const bound = scene.slab.field_bound();
  double const dt = scene.share * (bound == 0 ? 1 : 0.25 / bound);
  double const away = scene.number % 2 == 0 ? distance_after_return<RedBlack2<Spins>>(scene, dt)
                                            : distance_after_return<RedBlack4<Spins>>(scene, dt);
  return away / (16 * epsilon<Real> * scene.steps * std::exp(0.5 * dt * bound * scene.steps));
}

}  // namespace cayspin::test
