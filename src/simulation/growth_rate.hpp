// SPDX-License-Identifier: Apache-2.0 WITH LLVM-exception
#pragma once

#include "transition_rates.hpp"

#include <Eigen/Core>

namespace cayspin::simulation {

/// The rate at which the motion about a saddle grows, with damping: the only positive one, by
/// inverse iteration; 0 where none grows. `unstable`: the eigenvector of the Hessian that the
/// energy falls along. Throws NumbersFailed where a spin does not move.
double growth_rate(io::Scene const& scene, StateHessian const& saddle,
                   Eigen::MatrixXd const& hessian, Eigen::VectorXd const& unstable);

}  // namespace cayspin::simulation
