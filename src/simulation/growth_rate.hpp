// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "transition_rates.hpp"

#include <Eigen/Core>

#include <functional>

namespace cayspin::simulation {

/// Returns the rate at which a small deviation from a saddle grows in the damped dynamics. There is
/// only one positive rate; it is found by inverse iteration. Returns 0 if the search fails.
/// `unstable`: the eigenvector of the Hessian along which the energy falls. Calls poll() before
/// each factorisation; it may throw to interrupt the search. Throws NumbersFailed if a spin has
/// neither precession nor damping.
double growth_rate(io::Scene const& scene, StateHessian const& saddle,
                   Eigen::MatrixXd const& hessian, Eigen::VectorXd const& unstable,
                   std::function<void()> const& poll);

}  // namespace cayspin::simulation
