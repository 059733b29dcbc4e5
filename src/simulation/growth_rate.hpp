// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "transition_rates.hpp"

#include <Eigen/Core>

namespace cayspin::simulation {

/// Returns the rate at which deviations from a saddle grow in the motion with damping: the only
/// positive rate, found by inverse iteration, or 0 if none grows. `unstable`: the eigenvector of
/// the Hessian along which the energy falls. Throws NumbersFailed if a spin has neither precession
/// nor damping.
double growth_rate(io::Scene const& scene, StateHessian const& saddle,
                   Eigen::MatrixXd const& hessian, Eigen::VectorXd const& unstable);

}  // namespace cayspin::simulation
