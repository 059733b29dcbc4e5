// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "host_job.hpp"
#include "random_bodies.hpp"
#include "simulation/method_choice.hpp"

#include <vector>

namespace cayspin::paper {

/// Returns the [integrator] of a scene with this method, which steps from 0 to `end`.
io::Integrator integrator_of(MethodChoice const& choice, double dt, double end);

/// Results for each body.
struct EnsembleRun {
  std::vector<double> energy_errors;  // max over all steps of |H - H(start)|
  std::vector<Vector> ends;
};

/// Runs the bodies side by side by a method of the program, in double precision on the host.
void run_bodies(std::vector<Body> const& bodies, MethodChoice const& choice, double dt, double end,
                HostObserver& observer);
EnsembleRun run_ensemble(std::vector<Body> const& bodies, MethodChoice const& choice, double dt,
                         double end);

}  // namespace cayspin::paper
