// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "host_job.hpp"
#include "random_bodies.hpp"
#include "simulation/method_choice.hpp"

#include <vector>

namespace cayspin::paper {

/// Returns the section [integrator] of a scene, with this method and steps of dt from 0 to `end`.
io::Integrator integrator_of(MethodChoice const& choice, double dt, double end);

/// Results for each body.
struct EnsembleRun {
  std::vector<double> energy_errors;  // max over all steps of |H - H(start)|
  std::vector<Vector> ends;
};

/// Runs all bodies together, with a method of the program, in double precision on the host.
void run_bodies(std::vector<Body> const& bodies, MethodChoice const& choice, double dt, double end,
                HostObserver& observer);
EnsembleRun run_ensemble(std::vector<Body> const& bodies, MethodChoice const& choice, double dt,
                         double end);

}  // namespace cayspin::paper
