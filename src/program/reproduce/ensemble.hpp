// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "host_job.hpp"
#include "random_bodies.hpp"

#include <vector>

namespace cayspin::program::reproduction {

/// The part of a scene that says how it is integrated.
struct Choice {
  io::Method method = io::Method::euler;
  io::Generator generator = io::Generator::standard;
  io::Isotropy isotropy = io::Isotropy::zero;
  double sigma = 0;
  io::Rotation rotation = io::Rotation::cayley;

  io::Integrator integrator(double dt, double end) const;
};

/// What became of each body.
struct EnsembleRun {
  std::vector<double> energy_errors;  // max over all steps of |H - H(start)|
  std::vector<Vector> ends;
};

/// Runs the bodies side by side, by the program's own method, in double precision on the host.
void run_bodies(std::vector<Body> const& bodies, Choice const& choice, double dt, double end,
                HostObserver& observer);
EnsembleRun run_ensemble(std::vector<Body> const& bodies, Choice const& choice, double dt,
                         double end);

}  // namespace cayspin::program::reproduction
